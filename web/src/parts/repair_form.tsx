/** How a scan is to be repaired, besides what is chosen for single holes. */
import { post } from "../api/client";
import type { Job, JobSpec, Mesh, Plan, RulePage } from "../api/types";
import { useAction, useAnswer } from "../hooks";
import { type Choices, isOuter, rulesOf } from "../holes";
import { go } from "../route";
import { count, unitName } from "../text/format";
import { t } from "../text/text";
import { EffortChoice, type Effort } from "./effort";
import { Check, Choice, Field } from "./forms";
import { ProblemNote } from "./notes";
import { outerInWords, outerName } from "./outcome";

type Unit = NonNullable<JobSpec["length_unit"]>;
const UNITS: readonly Unit[] = ["micron", "millimeter", "centimeter", "meter", "inch", "foot"];

export interface Draft {
  effort: Effort;
  /** Name of a saved rule, which then says all there is to say about holes. */
  rule: string;
  widest: string;
  label: string;
  unit: Unit | null;
  hasReport: boolean;
}

export const EMPTY_DRAFT: Draft = { effort: "standard", rule: "", widest: "", label: "", unit: null, hasReport: true };

/** What a job was asked for, as far as the form can say it. */
export function draftOf({ method, holes, rule, label, length_unit }: JobSpec): Draft {
  return {
    ...EMPTY_DRAFT,
    effort: method?.method === "auto" ? (method.effort ?? "standard") : method?.method === "smooth" ? "fast" : "standard",
    rule: rule?.split("@")[0] ?? "",
    widest: holes?.max_diameter ? String(holes.max_diameter) : "",
    label: label ?? "",
    unit: length_unit ?? null,
  };
}

export function draftSpec(mesh_id: string, draft: Draft, choices: Choices): JobSpec {
  const spec: JobSpec = { mesh_id, priority: "interactive", output: { html_report: draft.hasReport } };
  if (draft.label) spec.label = draft.label;
  if (draft.unit) spec.length_unit = draft.unit;
  if (draft.rule) return { ...spec, rule: draft.rule };
  const rules = rulesOf(choices);
  const widest = Number(draft.widest);
  spec.method = { method: "auto", effort: draft.effort };
  spec.holes = { ...(widest > 0 ? { max_diameter: widest } : {}), ...(rules.length ? { rules } : {}) };
  return spec;
}

export function RepairForm(props: {
  draft: Draft;
  onChange: (draft: Draft) => void;
  mesh: Mesh;
  spec: JobSpec;
  plan: Plan | null;
  hasChoices: boolean;
}) {
  const { draft, mesh, plan } = props;
  const rules = useAnswer<RulePage>("/v1/rules?limit=100");
  const action = useAction();
  const change = (changes: Partial<Draft>) => props.onChange({ ...draft, ...changes });
  const start = async () => {
    const spec = { ...props.spec, ...(mesh.filename ? { mesh_name: mesh.filename } : {}) };
    go(`/jobs/${(await post<Job>("/v1/jobs", spec)).id}`);
  };
  const unit = unitName(mesh.facts?.unit ?? draft.unit);
  return (
    <form class="repair" onSubmit={(event) => (event.preventDefault(), void action.run(start))}>
      <h2>{t("repair")}</h2>
      {(rules.value?.items.length ?? 0) > 0 && (
        <Choice
          label={t("rule")}
          hint={t("rule_hint")}
          value={draft.rule}
          options={[["", t("no_rule")], ...(rules.value?.items ?? []).map(({ name }) => [name, name] as const)]}
          onChange={(rule) => change({ rule })}
        />
      )}
      {!draft.rule && <EffortChoice value={draft.effort} onChange={(effort) => change({ effort })} />}
      <details>
        <summary>{t("more_options")}</summary>
        {!draft.rule && (
          <Field
            label={`${t("widest_filled")} (${unit})`}
            hint={t("widest_hint")}
            type="number"
            value={draft.widest}
            onInput={(widest) => change({ widest })}
          />
        )}
        {mesh.facts && !mesh.facts.unit && (
          <Choice
            label={t("unit_of_file")}
            value={draft.unit ?? ""}
            options={[["", t("unit_not_said")], ...UNITS.map((name) => [name as Unit | "", unitName(name)] as const)]}
            onChange={(name) => change({ unit: name || null })}
          />
        )}
        <Field label={t("label")} value={draft.label} onInput={(label) => change({ label })} />
        <Check label={t("with_report")} checked={draft.hasReport} onChange={(hasReport) => change({ hasReport })} />
      </details>
      {plan && <p role="status">{planInWords(plan)}</p>}
      <p class="actions"><button class="primary" disabled={action.isBusy}>{t("start_repair")}</button></p>
      <ProblemNote problem={action.problem} />
    </form>
  );
}

function planInWords({ holes, selected }: Plan): string {
  const outer = holes.filter((hole) => !hole.selected && isOuter(hole.kind, hole.reason));
  const counts = t("plan_counts", { n: count(selected), of: count(holes.length - outer.length) });
  if (outer.length === 0) return counts;
  return `${counts} ${t("plan_outer", { which: outerInWords(outer.map(({ kind, reason }) => outerName(kind, reason))) })}`;
}
