/** All jobs, found by their states, labels, files and tasks. The address keeps the filter. */
import { withQuery } from "../api/client";
import type { Job, JobPage } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { Choice, Field, Pager, Table } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { currentRoute, go, type Route, useRoute } from "../route";
import { percent, time } from "../text/format";
import { t, tCode } from "../text/text";
import { State } from "./scans";

const STATES = [
  "queued", "running", "canceling", "succeeded", "succeeded_with_warnings", "failed", "canceled",
] as const;
const TASKS = ["fill", "restore", "denoise", "encode", "decode", "train"] as const;
const FILTERS = ["state", "task", "label", "filename", "mesh_id", "batch_id", "cursor"] as const;

export function JobsPage() {
  const chosen = filtersOf(useRoute());
  useTitle(t("section_jobs"));
  // The address of now: it may have changed since this was drawn.
  const change = (changes: Record<string, string>) =>
    go(withQuery("/jobs", { ...filtersOf(currentRoute()), cursor: "", ...changes }));
  const path = withQuery("/v1/jobs", { ...chosen, label: pattern(chosen.label), filename: pattern(chosen.filename) });
  const jobs = useAnswer<JobPage>(path);
  return (
    <>
      <h1>{t("section_jobs")}</h1>
      <div class="filters" role="search">
        <Choice
          label={t("state")}
          value={chosen.state}
          options={[["", t("all")], ...STATES.map((state) => [state, tCode("job_state", state)] as const)]}
          onChange={(state) => change({ state })}
        />
        <Choice
          label={t("task")}
          value={chosen.task}
          options={[["", t("all")], ...TASKS.map((task) => [task, tCode("task", task)] as const)]}
          onChange={(task) => change({ task })}
        />
        <Field label={t("label")} value={chosen.label} onInput={(label) => change({ label })} />
        <Field label={t("file_name")} value={chosen.filename} onInput={(filename) => change({ filename })} />
      </div>
      {(chosen.batch_id || chosen.mesh_id) && (
        <p>
          {chosen.batch_id ? t("jobs_of_batch", { id: chosen.batch_id }) : t("jobs_of_mesh")}{" "}
          <button type="button" onClick={() => change({ batch_id: "", mesh_id: "" })}>{t("all")}</button>
        </p>
      )}
      <ProblemNote problem={jobs.problem} />
      {jobs.value === null && !jobs.problem && <Loading />}
      {jobs.value?.items.length === 0 && <p>{t("nothing_here")}</p>}
      {jobs.value && jobs.value.items.length > 0 && <JobTable jobs={jobs.value.items} />}
      <p class="actions"><button type="button" onClick={jobs.reload}>{t("reload")}</button></p>
      <Pager
        next={jobs.value?.next_cursor}
        onNext={(cursor) => change({ cursor })}
        onFirst={chosen.cursor ? () => change({}) : undefined}
      />
    </>
  );
}

function filtersOf({ query }: Route): Record<(typeof FILTERS)[number], string> {
  return Object.fromEntries(FILTERS.map((name) => [name, query.get(name) ?? ""])) as Record<(typeof FILTERS)[number], string>;
}

export function JobTable({ jobs }: { jobs: Job[] }) {
  return (
    <Table caption={t("section_jobs")} heads={[t("job"), t("state"), t("progress"), t("task"), t("label"), t("created_at")]}>
      {jobs.map((job) => (
        <tr key={job.id}>
          <td><a href={`#/jobs/${job.id}`}>{job.mesh_name ?? job.id}</a></td>
          <td><State of={job.state} group="job_state" /></td>
          <td class="number">{percent(job.percent / 100)}</td>
          <td>{tCode("task", job.spec.task ?? "fill")}</td>
          <td>{job.spec.label ?? "–"}</td>
          <td>{time(job.created_at)}</td>
        </tr>
      ))}
    </Table>
  );
}

function pattern(text: string): string {
  return text && !text.includes("*") ? `*${text}*` : text;
}
