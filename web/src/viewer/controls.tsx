/** What can be changed about the view: colours, outlines, section, measuring; and what the colours mean. */
import { Check, Choice } from "../parts/forms";
import { count, length, percent } from "../text/format";
import { t } from "../text/text";
import type { Axis } from "./scene";
import type { Surface } from "./surface";
import type { Measure, Tint } from "./tints";

export interface Settings {
  tint: Tint;
  hasRims: boolean;
  /** The axis that a section plane lies across, and where, as a share of the way through the scan. */
  axis: Axis | null;
  cut: number;
  isMeasuring: boolean;
  /** Left of this share of the picture the scan is shown as it was. */
  split: number;
}

export const START_SETTINGS: Settings = { tint: "plain", hasRims: true, axis: null, cut: 0.5, isMeasuring: false, split: 0.5 };

export function Controls(props: {
  settings: Settings;
  onChange: (changes: Partial<Settings>) => void;
  surface: Surface | null;
  hasAfter: boolean;
  onShowAll: () => void;
}) {
  const { settings, onChange, surface, hasAfter } = props;
  const tints: Tint[] = ["plain", ...(surface?.about.has_colours ? ["colours" as const] : []), ...(surface?.measures() ?? [])];
  return (
    <div class="controls" role="group" aria-label={t("view_controls")}>
      <Choice
        label={t("tint")}
        value={settings.tint}
        options={tints.map((tint) => [tint, tint === "plain" ? t(hasAfter ? "tint_plain_after" : "tint_plain") : t(`tint_${tint}`)] as const)}
        onChange={(tint) => onChange({ tint })}
      />
      <Choice
        label={t("section_plane")}
        value={settings.axis ?? "none"}
        options={[["none", t("no_section")], ["x", "X"], ["y", "Y"], ["z", "Z"]]}
        onChange={(axis) => onChange({ axis: axis === "none" ? null : axis })}
      />
      {settings.axis && (
        <label class="field">
          {t("section_place")}
          <input
            type="range"
            min={0}
            max={1}
            step={0.005}
            value={settings.cut}
            aria-valuetext={percent(settings.cut)}
            onInput={(event) => onChange({ cut: Number(event.currentTarget.value) })}
          />
        </label>
      )}
      <Check label={t("show_outlines")} checked={settings.hasRims} onChange={(hasRims) => onChange({ hasRims })} />
      <button type="button" aria-pressed={settings.isMeasuring} onClick={() => onChange({ isMeasuring: !settings.isMeasuring })}>
        {t("measure")}
      </button>
      <button type="button" onClick={props.onShowAll}>{t("show_all")}</button>
    </div>
  );
}

/** What the colours mean, and whether all triangles are shown. */
export function Legend({ surface, tint, unit }: { surface: Surface; tint: Tint; unit: string | null | undefined }) {
  const { triangles, is_reduced } = surface.about;
  return (
    <div class="legend">
      {tint !== "plain" && tint !== "colours" && <Scale surface={surface} measure={tint} unit={unit} />}
      {tint === "plain" && surface.meshes.some((mesh) => mesh.name === "invented") && (
        <p><span class="swatch measured" /> {t("measured")} <span class="swatch invented" /> {t("invented")}</p>
      )}
      <small>{t(is_reduced ? "triangles_reduced" : "triangles_all", { n: count(triangles) })}</small>
    </div>
  );
}

function Scale({ surface, measure, unit }: { surface: Surface; measure: Measure; unit: string | null | undefined }) {
  if (!surface.measures().includes(measure)) return <p>{t("tint_not_there")}</p>;
  const write = (value: number) => (measure === "confidence" ? percent(value) : length(value, unit));
  const [low, high] = surface.range(measure);
  return (
    <p class="scale">
      {t(`tint_${measure}`)}: {write(low)} <span class="gradient" aria-hidden="true" /> {write(high)}
    </p>
  );
}
