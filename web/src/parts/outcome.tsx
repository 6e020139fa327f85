/** What came out of a repair, in one sentence. */
import type { HoleReport } from "../api/types";
import { isLeftOpen, isOuter } from "../holes";
import { count } from "../text/format";
import { t, tCode } from "../text/text";

export function Outcome({ holes }: { holes: readonly HoleReport[] }) {
  const outer = holes.filter(({ verdict, kind, code }) => verdict === "skipped" && isOuter(kind, code));
  const open = holes.filter((hole) => isLeftOpen(hole) && !outer.includes(hole));
  const n = holes.length - outer.length;
  const filled = t("outcome_filled", { n: count(n - open.length), of: count(n) });
  const left = open.length > 0 && t("outcome_open", { n: count(open.length), why: reasons(open) });
  const apart = outer.length > 0 && t("outcome_outer", { which: outerInWords(outer.map(({ kind, code }) => outerName(kind, code))) });
  const counted = [filled, left].filter(Boolean).join(", ");
  return <p><strong>{[counted, apart].filter(Boolean).join("; ")}</strong></p>;
}

/** What a loop is that is no hole. */
export function outerName(kind: string | undefined, why: string | null | undefined): string {
  return kind === "border" ? tCode("kind", kind) : tCode("reason", why ?? "");
}

/** Loops that are no holes and stay open, by their names. */
export function outerInWords(names: readonly string[]): string {
  const counts = new Map<string, number>();
  for (const name of names) counts.set(name, (counts.get(name) ?? 0) + 1);
  const each = [...counts].map(([name, n]) => (n > 1 ? `${count(n)} × ${name}` : name));
  return each.join(", ");
}

/** Why holes stay open; where there are several reasons, with the number of holes of each. */
function reasons(open: readonly HoleReport[]): string {
  const counts = new Map<string, number>();
  for (const { code, verdict } of open) {
    const why = code ? tCode("reason", code) : tCode("verdict", verdict);
    counts.set(why, (counts.get(why) ?? 0) + 1);
  }
  if (counts.size === 1) return [...counts.keys()][0]!;
  return [...counts].map(([why, n]) => `${count(n)} × ${why}`).join(", ");
}
