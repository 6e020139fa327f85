/** All batches, and a form that starts one over uploaded scans. */
import { useState } from "preact/hooks";
import { post, withQuery } from "../api/client";
import type { Batch, BatchPage, NewBatch } from "../api/types";
import { useAction, useAnswer, useTitle } from "../hooks";
import { EffortChoice, type Effort } from "../parts/effort";
import { Field, Pager, Table } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { go } from "../route";
import { count, time } from "../text/format";
import { t, tCode } from "../text/text";
import { State } from "./scans";

export function BatchesPage() {
  const [cursor, setCursor] = useState<string | null>(null);
  const batches = useAnswer<BatchPage>(withQuery("/v1/batches", { cursor }));
  useTitle(t("section_batches"));
  return (
    <>
      <h1>{t("section_batches")}</h1>
      <ProblemNote problem={batches.problem} />
      {batches.value === null && !batches.problem && <Loading />}
      {batches.value?.items.length === 0 && <p>{t("nothing_here")}</p>}
      {batches.value && batches.value.items.length > 0 && (
        <Table caption={t("section_batches")} heads={[t("batch"), t("state"), t("jobs"), t("progress"), t("created_at")]}>
          {batches.value.items.map((batch) => (
            <tr key={batch.id}>
              <td><a href={`#/batches/${batch.id}`}>{batch.label ?? batch.id}</a></td>
              <td><State of={batch.state} group="batch_state" /></td>
              <td class="number">{count(batch.n_jobs)}</td>
              <td>{countsInWords(batch)}</td>
              <td>{time(batch.created_at)}</td>
            </tr>
          ))}
        </Table>
      )}
      <Pager next={batches.value?.next_cursor} onNext={setCursor} onFirst={cursor ? () => setCursor(null) : undefined} />
      <NewBatchForm />
    </>
  );
}

export function countsInWords(batch: Batch): string {
  return Object.entries(batch.counts)
    .filter(([, n]) => n > 0)
    .map(([state, n]) => `${tCode("job_state", state)}: ${count(n)}`)
    .join(", ");
}

function NewBatchForm() {
  const [filename, setFilename] = useState("");
  const [label, setLabel] = useState("");
  const [effort, setEffort] = useState<Effort>("standard");
  const action = useAction();
  const start = async () => {
    const batch: NewBatch = {
      filter: { filename: filename || "*" },
      spec: { method: { method: "auto", effort } },
      label: label || null,
    };
    go(`/batches/${(await post<Batch>("/v1/batches", batch)).id}`);
  };
  return (
    <form class="card" onSubmit={(event) => (event.preventDefault(), void action.run(start))}>
      <h2>{t("new_batch")}</h2>
      <Field label={t("file_name")} hint={t("pattern_hint")} value={filename} onInput={setFilename} required />
      <Field label={t("label")} value={label} onInput={setLabel} />
      <EffortChoice value={effort} onChange={setEffort} />
      <p class="actions"><button class="primary" disabled={action.isBusy}>{t("start_batch")}</button></p>
      <ProblemNote problem={action.problem} />
    </form>
  );
}
