/** The 3D view with its controls: loads surfaces, a coarse one first, and draws what its props say. */
import { useEffect, useRef, useState } from "preact/hooks";
import { withQuery } from "../api/client";
import { asProblem, Problem } from "../api/problem";
import { view } from "../api/views";
import type { Choices } from "../holes";
import { ProblemNote } from "../parts/notes";
import { length } from "../text/format";
import { t } from "../text/text";
import { Controls, Legend, type Settings, START_SETTINGS } from "./controls";
import type { Outlines } from "./rims";
import { MeshScene, type Role } from "./scene";
import { Surface } from "./surface";

const TURN = Math.PI / 24;
const NEARER = 1.2;
/** A press that moved farther than this many pixels turned the scan, and chose nothing. */
const CLICK_PIXELS = 4;

interface Props {
  before: string;
  after?: string;
  reference?: string | null;
  outlines: string | null;
  unit: string | null | undefined;
  choices?: Choices;
  selected: number | null;
  nSelections: number;
  onSelect: (id: number) => void;
}

export function Viewer(props: Props) {
  const { before, after, reference, outlines, unit, choices, selected } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const overlay = useRef<HTMLDivElement>(null);
  const [scene, setScene] = useState<MeshScene | null>(null);
  const [settings, setSettings] = useState<Settings>(START_SETTINGS);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [distance, setDistance] = useState<number | null>(null);
  const [nRims, setRims] = useState(0);
  const onSelect = useRef(props.onSelect);
  onSelect.current = props.onSelect;

  useEffect(() => {
    let made: MeshScene | null = null;
    try {
      made = new MeshScene(canvas.current!, overlay.current!, (id) => onSelect.current(id));
    } catch (error) {
      setProblem(new Problem("no_webgl", error instanceof Error ? error.message : "", 0));
    }
    setScene(made);
    return () => made?.dispose();
  }, []);

  const loaded = {
    before: useSurface(scene, "before", before, settings, setProblem),
    after: useSurface(scene, "after", after ? withQuery(after, { reference }) : null, settings, setProblem),
  };
  const isFirstThere = loaded.before !== null || loaded.after !== null;
  useEffect(() => {
    if (!scene || !outlines || !isFirstThere) return;
    const asking = new AbortController();
    view(outlines, asking.signal)
      .then((response) => response.json())
      .then((found: Outlines) => (scene.setOutlines(found), setRims((n) => n + 1)))
      .catch((error: unknown) => asking.signal.aborted || setProblem(asProblem(error)));
    return () => asking.abort();
  }, [scene, outlines, isFirstThere]);

  useEffect(() => scene?.colourRims((id) => choices?.get(id) ?? "auto", selected), [scene, nRims, choices, selected]);
  useEffect(() => scene?.showRims(settings.hasRims), [scene, nRims, settings.hasRims]);
  useEffect(() => scene?.tint(settings.tint), [scene, settings.tint]);
  useEffect(() => scene?.setSplit(settings.split), [scene, settings.split]);
  useEffect(() => scene?.cut(settings.axis, settings.cut), [scene, settings.axis, settings.cut]);
  useEffect(() => {
    if (selected !== null) scene?.flyTo(selected);
  }, [scene, nRims, props.nSelections]);
  // Who uploads a scan with colours looks for them.
  const hasColours = !after && loaded.before?.about.has_colours;
  useEffect(() => {
    if (hasColours) setSettings((known) => ({ ...known, tint: "colours" }));
  }, [hasColours]);
  useEffect(() => {
    if (reference) setSettings((known) => ({ ...known, tint: "distance_to_reference" }));
  }, [reference]);

  const measure = (x: number, y: number) => {
    const point = scene?.surfaceAt(x, y);
    if (!scene || !point) return;
    scene.measuring.take(point);
    setDistance(scene.measuring.distance);
    scene.draw();
  };
  const change = (changes: Partial<Settings>) => {
    if (changes.isMeasuring === false && scene) {
      scene.measuring.clear();
      setDistance(null);
      scene.draw();
    }
    setSettings((known) => ({ ...known, ...changes }));
  };
  const onClick = (x: number, y: number) => {
    if (settings.isMeasuring) return measure(x, y);
    const hole = scene?.holeAt(x, y) ?? null;
    if (hole !== null) props.onSelect(hole);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (!scene || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Enter" && settings.isMeasuring) measure(0, 0);
    else if (event.key === "m") change({ isMeasuring: !settings.isMeasuring });
    else if (!turnByKey(scene, event.key)) return;
    event.preventDefault();
  };
  const shown = loaded.after ?? loaded.before;
  return (
    <section class="viewer" aria-label={t("view_3d")}>
      <Controls settings={settings} onChange={change} surface={shown} hasAfter={loaded.after !== null} onShowAll={() => scene?.showAll()} />
      <div class="picture-area">
        <canvas
          ref={canvas}
          tabIndex={0}
          role="application"
          aria-label={t("canvas_label")}
          aria-roledescription={t("view_3d")}
          onKeyDown={onKeyDown}
          {...clicks(onClick)}
        />
        <div class={`overlay${settings.isMeasuring ? " measuring" : ""}`} ref={overlay} aria-hidden="true" />
        {settings.isMeasuring && <div class="crosshair" aria-hidden="true" />}
        {loaded.after && loaded.before && (
          <Compare split={settings.split} onChange={(split) => change({ split })} />
        )}
        {!isFirstThere && !problem && <p class="over" role="status">{t("view_is_made")}</p>}
      </div>
      <p class="readout" role="status">
        {settings.isMeasuring && (distance === null ? t("measure_how") : `${t("distance")}: ${length(distance, unit)}`)}
      </p>
      {shown && <Legend surface={shown} tint={settings.tint} unit={unit} />}
      <ProblemNote problem={problem} />
    </section>
  );
}

function Compare({ split, onChange }: { split: number; onChange: (split: number) => void }) {
  return (
    <>
      <div class="split" style={{ left: `${100 * split}%` }} aria-hidden="true" />
      <span class="tag left" aria-hidden="true">{t("before")}</span>
      <span class="tag right" aria-hidden="true">{t("after")}</span>
      <input
        class="compare"
        type="range"
        min={0}
        max={1}
        step={0.01}
        value={split}
        aria-label={t("before_after")}
        aria-valuetext={t("share_before", { n: Math.round(100 * split) })}
        onInput={(event) => onChange(Number(event.currentTarget.value))}
      />
    </>
  );
}

/** Load a view, a coarse one first, and show it. Returns what is shown. */
function useSurface(
  scene: MeshScene | null,
  role: Role,
  path: string | null,
  settings: Settings,
  onProblem: (problem: Problem) => void,
): Surface | null {
  const [shown, setShown] = useState<Surface | null>(null);
  const tint = useRef(settings.tint);
  tint.current = settings.tint;
  useEffect(() => {
    if (!scene || path === null) return;
    const asking = new AbortController();
    const load = async (level: "coarse" | "fine"): Promise<Surface> => {
      const response = await view(withLevel(path, level), asking.signal);
      const surface = await Surface.read(await response.arrayBuffer());
      asking.signal.throwIfAborted();
      scene.setSurface(role, surface, tint.current);
      setShown(surface);
      return surface;
    };
    load("coarse")
      .then((surface) => (surface.about.is_reduced ? load("fine") : surface))
      .catch((error: unknown) => asking.signal.aborted || onProblem(asProblem(error)));
    return () => asking.abort();
  }, [scene, path]);
  return shown;
}

function withLevel(path: string, level: string): string {
  return `${path}${path.includes("?") ? "&" : "?"}level=${level}`;
}

/** Handlers that call `onClick` with a place of the picture, (-1, -1) to (1, 1), where the pointer did not drag. */
function clicks(onClick: (x: number, y: number) => void) {
  let start: [number, number] = [0, 0];
  return {
    onPointerDown: (event: PointerEvent) => {
      start = [event.clientX, event.clientY];
    },
    onPointerUp: (event: PointerEvent) => {
      if (Math.hypot(event.clientX - start[0], event.clientY - start[1]) > CLICK_PIXELS || event.button !== 0) return;
      const { left, top, width, height } = (event.currentTarget as HTMLElement).getBoundingClientRect();
      onClick((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
    },
  };
}

function turnByKey(scene: MeshScene, key: string): boolean {
  if (key === "ArrowLeft") scene.turn(-TURN, 0);
  else if (key === "ArrowRight") scene.turn(TURN, 0);
  else if (key === "ArrowUp") scene.turn(0, -TURN);
  else if (key === "ArrowDown") scene.turn(0, TURN);
  else if (key === "+" || key === "=") scene.turn(0, 0, NEARER);
  else if (key === "-") scene.turn(0, 0, 1 / NEARER);
  else if (key === "0" || key === "Home") scene.showAll();
  else return false;
  return true;
}

