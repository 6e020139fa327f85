/** Colours that say a number of each vertex: what can be shown, and the colour of a value. */
import { Color } from "three";

/** Attributes of a view that are shown as colours; three writes their names in lower case. */
export const MEASURES = {
  confidence: "_confidence",
  expected_error: "_expected_error",
  distance_to_plain_fill: "_distance_to_plain_fill",
  distance_to_reference: "_distance_to_reference",
} as const;
export type Measure = keyof typeof MEASURES;
/** `plain`: what is new in another colour. `colours`: those of the scan. */
export type Tint = "plain" | "colours" | Measure;

/** Viridis at nine even places: dark is small, in grey tones, too (van der Walt and Smith, 2015). */
const VIRIDIS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"].map(
  (text) => new Color(text),
);

/** The colour of a share between 0 and 1. */
export function colourOf(share: number, into: Color): Color {
  const at = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return into.lerpColors(VIRIDIS[below]!, VIRIDIS[below + 1]!, at - below);
}

/** Colours of values, three for each; those below 0 are unknown, and get `unknown`. */
export function coloursOf(values: ArrayLike<number>, [low, high]: readonly [number, number], unknown: Color): Float32Array {
  const colours = new Float32Array(3 * values.length);
  const colour = new Color();
  const span = high - low || 1;
  for (let i = 0; i < values.length; i += 1) {
    const value = values[i] ?? -1;
    (value < 0 ? unknown : colourOf((value - low) / span, colour)).toArray(colours, 3 * i);
  }
  return colours;
}
