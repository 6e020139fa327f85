/** A scan in 3D beside what is said of it: the list of holes, and what can be done. Both select the same hole. */
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import type { Action, Choices, HoleRow } from "../holes";
import { Viewer } from "./viewer";

/** Keys that choose what is done with the selected hole. */
const CHOICES: Record<string, Action> = { f: "model", l: "skip", s: "smooth", x: "flat", a: "auto" };

export function Workspace(props: {
  /** Paths of views. */
  before: string;
  after?: string;
  /** Id of a mesh that the repaired one is compared with. */
  reference?: string | null;
  outlines: string | null;
  holes: readonly HoleRow[];
  unit: string | null | undefined;
  choices?: Choices;
  onChoose?: ((id: number, action: Action) => void) | undefined;
  list: (selected: number | null, onSelect: (id: number) => void) => ComponentChildren;
  children: ComponentChildren;
}) {
  const { holes } = props;
  const [selected, setSelected] = useState<number | null>(null);
  // Selected again, it is flown to again.
  const [nSelections, setSelections] = useState(0);
  const select = (id: number) => (setSelected(id), setSelections((n) => n + 1));
  const step = (by: number) => {
    const at = holes.findIndex((hole) => hole.id === selected);
    const next = holes[at < 0 ? 0 : (at + by + holes.length) % holes.length];
    if (next) select(next.id);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const target = event.target as HTMLElement;
    if (target.closest("input, select, textarea") || event.ctrlKey || event.altKey || event.metaKey) return;
    const key = event.key.toLowerCase();
    const action = CHOICES[key];
    if (key === "n") step(1);
    else if (key === "p") step(-1);
    else if (action && props.onChoose && selected !== null) props.onChoose(selected, action);
    else return;
    event.preventDefault();
  };
  return (
    <div class="workspace" onKeyDown={onKeyDown}>
      <Viewer {...props} selected={selected} nSelections={nSelections} onSelect={select} />
      <div class="side">
        {props.list(selected, select)}
        {props.children}
      </div>
    </div>
  );
}
