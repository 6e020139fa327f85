/** Saved rules: what is done with holes, and what a result has to meet. */
import { useState } from "preact/hooks";
import { send } from "../api/client";
import type { HoleRule, Rule, RuleContent, RulePage } from "../api/types";
import { useAction, useAnswer, useTitle } from "../hooks";
import { EffortChoice, type Effort } from "../parts/effort";
import { ActionButton, Choice, Field } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { limitPercent, number, time } from "../text/format";
import { t, tCode } from "../text/text";

export function RulesPage() {
  const rules = useAnswer<RulePage>("/v1/rules?limit=100");
  useTitle(t("section_rules"));
  return (
    <>
      <h1>{t("section_rules")}</h1>
      <p>{t("rules_why")}</p>
      <ProblemNote problem={rules.problem} />
      {rules.value === null && !rules.problem && <Loading />}
      {rules.value?.items.length === 0 && <p>{t("nothing_here")}</p>}
      {rules.value?.items.map((rule) => <RuleCard key={rule.name} rule={rule} onDeleted={rules.reload} />)}
      <NewRule onSaved={rules.reload} />
    </>
  );
}

function RuleCard({ rule, onDeleted }: { rule: Rule; onDeleted: () => void }) {
  const remove = async () => {
    await send("DELETE", `/v1/rules/${encodeURIComponent(rule.name)}`);
    onDeleted();
  };
  return (
    <section class="card">
      <h2>{rule.name}@{rule.version}</h2>
      <p>{rule.content.description}</p>
      <ul>{inWords(rule.content).map((line) => <li key={line}>{line}</li>)}</ul>
      <p><small>{time(rule.created_at)}</small></p>
      <ActionButton label={t("delete")} work={remove} confirm={t("delete_rule_sure", { name: rule.name })} />
    </section>
  );
}

/** What a rule says, a sentence for each thing. */
export function inWords({ holes, method, acceptance }: RuleContent): string[] {
  const lines: string[] = [];
  if (holes?.max_diameter != null) lines.push(t("rule_max_diameter", { value: number(holes.max_diameter) }));
  if (holes?.max_perimeter != null) lines.push(t("rule_max_perimeter", { value: number(holes.max_perimeter) }));
  if (holes?.ids) lines.push(t("rule_ids", { ids: holes.ids.join(", ") }));
  if (holes?.include_borders) lines.push(t("rule_borders"));
  if (holes?.cap) lines.push(t("rule_cap"));
  for (const rule of holes?.rules ?? []) lines.push(`${conditions(rule)}: ${tCode("action", rule.action)}`);
  if (method?.method === "auto") lines.push(`${t("effort")}: ${t(`effort_${method.effort ?? "standard"}`)}`);
  else if (method) lines.push(`${t("method")}: ${tCode("method", method.method)}`);
  if (acceptance?.max_expected_error != null) lines.push(t("rule_max_error", { value: number(acceptance.max_expected_error) }));
  if (acceptance?.max_error_share != null) lines.push(t("rule_max_share", { value: limitPercent(acceptance.max_error_share) }));
  if (acceptance?.min_confidence != null) lines.push(t("rule_min_confidence", { value: limitPercent(acceptance.min_confidence) }));
  if (acceptance) lines.push(t(acceptance.otherwise === "fail" ? "rule_else_fail" : "rule_else_warn"));
  return lines;
}

function conditions(rule: HoleRule): string {
  const parts: string[] = [];
  if (rule.ids) parts.push(`${t("hole")} ${rule.ids.join(", ")}`);
  if (rule.kind) parts.push(tCode("kind", rule.kind));
  if (rule.min_diameter != null) parts.push(t("at_least", { value: number(rule.min_diameter) }));
  if (rule.max_diameter != null) parts.push(t("at_most", { value: number(rule.max_diameter) }));
  if (rule.max_perimeter != null) parts.push(t("perimeter_at_most", { value: number(rule.max_perimeter) }));
  return parts.join(", ") || t("all");
}

function NewRule({ onSaved }: { onSaved: () => void }) {
  const [name, setName] = useState("");
  const [description, setDescription] = useState("");
  const [widest, setWidest] = useState("");
  const [error, setError] = useState("");
  const [otherwise, setOtherwise] = useState<"warn" | "fail">("warn");
  const [effort, setEffort] = useState<Effort>("standard");
  const action = useAction();
  const save = async () => {
    const content: RuleContent = { method: { method: "auto", effort } };
    if (description) content.description = description;
    if (widest) content.holes = { max_diameter: Number(widest) };
    if (error) content.acceptance = { max_expected_error: Number(error), otherwise };
    await send("PUT", `/v1/rules/${encodeURIComponent(name)}`, content);
    onSaved();
  };
  return (
    <form class="card" onSubmit={(event) => (event.preventDefault(), void action.run(save))}>
      <h2>{t("new_rule")}</h2>
      <Field label={t("name")} hint={t("new_rule_hint")} value={name} onInput={setName} required />
      <Field label={t("description")} value={description} onInput={setDescription} />
      <Field label={t("widest_filled")} hint={t("in_units_of_file")} type="number" value={widest} onInput={setWidest} />
      <Field label={t("largest_error")} hint={t("in_units_of_file")} type="number" value={error} onInput={setError} />
      <Choice
        label={t("otherwise")}
        value={otherwise}
        options={[["warn", t("rule_else_warn")], ["fail", t("rule_else_fail")]]}
        onChange={setOtherwise}
      />
      <EffortChoice value={effort} onChange={setEffort} />
      <p class="actions"><button class="primary" disabled={action.isBusy}>{t("save")}</button></p>
      <ProblemNote problem={action.problem} />
    </form>
  );
}
