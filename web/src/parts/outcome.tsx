/** What came out of a repair, in one sentence. */
import type { HoleReport } from "../api/types";
import { isLeftOpen } from "../holes";
import { count } from "../text/format";
import { t, tCode } from "../text/text";

export function Outcome({ holes }: { holes: readonly HoleReport[] }) {
  const open = holes.filter(isLeftOpen);
  const filled = t("outcome_filled", { n: count(holes.length - open.length), of: count(holes.length) });
  const left = open.length > 0 && t("outcome_open", { n: count(open.length), why: reasons(open) });
  return <p><strong>{[filled, left].filter(Boolean).join(", ")}</strong></p>;
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
