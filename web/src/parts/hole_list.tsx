/** All holes as a table: a number flies to its hole; before a repair each has a choice, after it a verdict. */
import { useEffect, useRef, useState } from "preact/hooks";
import { ACTIONS, type Action, type Choices, type HoleRow } from "../holes";
import { coordinates, count, number, percent, unitName } from "../text/format";
import { t, tCode } from "../text/text";

// A browser is slow with thousands of rows.
const STEP = 100;

interface Props {
  holes: readonly HoleRow[];
  unit: string | null | undefined;
  /** Length of the diagonal of the scan's box; null where it is not known. */
  diagonal: number | null;
  selected: number | null;
  onSelect: (id: number) => void;
  choices?: Choices;
  onChoose?: (id: number, action: Action) => void;
}

export function HoleList(props: Props) {
  const { holes, selected, unit } = props;
  const [nShown, setShown] = useState(STEP);
  const body = useRef<HTMLTableSectionElement>(null);
  const at = holes.findIndex((hole) => hole.id === selected);
  useEffect(() => {
    if (at >= nShown) setShown(at + STEP);
    if (body.current) showRow(body.current);
  }, [at, nShown]);
  if (holes.length === 0) return <p>{t("no_holes")}</p>;
  const isReport = holes.some((hole) => hole.confidence !== undefined);
  return (
    <div class="table holes" tabIndex={0} role="region" aria-label={t("holes")}>
      <table>
        <caption class="hidden">{t("holes_caption")}</caption>
        <thead>
          <tr>
            <th scope="col">{t("hole")}<small>{t("place")}</small></th>
            <th scope="col">{t("diameter")} ({unitName(unit)})</th>
            <th scope="col">{props.onChoose ? t("choice") : t("verdict")}</th>
            {isReport && (
              <th scope="col">{t("confidence")}<small>{t("expected_error")} ({unitName(unit)})</small></th>
            )}
          </tr>
        </thead>
        <tbody ref={body}>
          {holes.slice(0, nShown).map((hole) => <Row key={hole.id} hole={hole} isReport={isReport} {...props} />)}
        </tbody>
      </table>
      {holes.length > nShown && (
        <p class="actions">
          <button type="button" onClick={() => setShown(nShown + STEP)}>
            {t("more_holes", { n: count(holes.length - nShown) })}
          </button>
        </p>
      )}
    </div>
  );
}

/** Scroll the list, and not the page, until the selected row is seen. */
function showRow(body: HTMLElement): void {
  const [row, list] = [body.querySelector<HTMLElement>("tr.selected"), body.closest<HTMLElement>(".holes")];
  if (!row || !list) return;
  const head = list.querySelector("thead")?.offsetHeight ?? 0;
  const below = row.offsetTop + row.offsetHeight - list.clientHeight;
  list.scrollTop = Math.min(Math.max(list.scrollTop, below), row.offsetTop - head);
}

function Row({ hole, diagonal, selected, onSelect, choices, onChoose, isReport }: Props & { hole: HoleRow; isReport: boolean }) {
  const isSelected = hole.id === selected;
  return (
    <tr class={isSelected ? "selected" : ""} data-hole={hole.id}>
      <th scope="row">
        <button
          type="button"
          class="number"
          aria-pressed={isSelected}
          aria-label={t("fly_to_hole", { id: hole.id })}
          onClick={() => onSelect(hole.id)}
        >
          {hole.id}
        </button>{" "}
        <small>{tCode("kind", hole.kind)}</small>
        <small class="place">{coordinates(hole.centre, diagonal)}</small>
      </th>
      <td class="number">{number(hole.diameter)}</td>
      <td>
        {onChoose && (
          <select
            aria-label={t("choice_of_hole", { id: hole.id })}
            value={choices?.get(hole.id) ?? "auto"}
            onChange={(event) => onChoose(hole.id, event.currentTarget.value as Action)}
          >
            {ACTIONS.map((action) => <option key={action} value={action}>{t(`choice_${action}`)}</option>)}
          </select>
        )}
        <small class={hole.isOpen ? "open" : "closed"}>{hole.note}</small>
        {hole.isUnmet && <small class="unmet">{t("misses_limits")}</small>}
      </td>
      {isReport && (
        <td class="number">
          {percent(hole.confidence)}
          <small>{hole.expectedError != null ? number(hole.expectedError, 2) : "–"}</small>
        </td>
      )}
    </tr>
  );
}
