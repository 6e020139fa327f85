/** What is done with each hole: what a person chose, as rules of a job. */
import type { HoleReport, HoleRule } from "./api/types";

export const ACTIONS = ["auto", "model", "smooth", "flat", "skip"] as const;
export type Action = (typeof ACTIONS)[number];
/** By the ids of holes; one that is missing is left to the automatic rule. */
export type Choices = ReadonlyMap<number, Action>;

export function withChoice(choices: Choices, id: number, action: Action): Choices {
  const changed = new Map(choices);
  if (action === "auto") changed.delete(id);
  else changed.set(id, action);
  return changed;
}

/** One rule for each action, with the ids of its holes. */
export function rulesOf(choices: Choices): HoleRule[] {
  const actions = [...new Set(choices.values())].filter((action) => action !== "auto");
  return actions.map((action) => ({
    action,
    ids: [...choices].filter(([, chosen]) => chosen === action).map(([id]) => id),
  }));
}

/** What was chosen for single holes, out of the rules of a job. */
export function choicesOf(rules: readonly HoleRule[]): Choices {
  return new Map(rules.flatMap((rule) => (rule.ids ?? []).map((id): [number, Action] => [id, rule.action])));
}

/** Reasons that a loop is left open for what it is: the border of an open scan, or an open end, is no damage. */
const OUTER = new Set(["border", "open_end", "largest"]);

/** Whether a loop that no fill was tried for is no hole: an outer border, whatever rule leaves it open, or an open end. */
export function isOuter(kind: string | undefined, why: string | null | undefined): boolean {
  return kind === "border" || OUTER.has(why ?? "");
}

export function isLeftOpen({ verdict }: HoleReport): boolean {
  return verdict === "skipped" || verdict === "refused";
}

/** What is known of a hole before a repair, in a plan, or after it. */
export interface HoleRow {
  id: number;
  kind: string;
  diameter: number;
  perimeter: number;
  centre: readonly number[] | null;
  /** A state in words: what would be done, or what was. */
  note: string;
  isOpen: boolean;
  confidence?: number | null;
  expectedError?: number | null;
  /** Whether it misses a limit of the rule. */
  isUnmet?: boolean;
}
