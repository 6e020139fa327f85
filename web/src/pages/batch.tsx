/** One batch: how far it is, its files and jobs. */
import { useEffect, useState } from "preact/hooks";
import { get, post } from "../api/client";
import { readEvents } from "../api/events";
import { asProblem, missingOf, type Problem } from "../api/problem";
import type { Batch, JobPage } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { ActionButton, DownloadButton, Facts } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { go } from "../route";
import { duration, time } from "../text/format";
import { t } from "../text/text";
import { countsInWords } from "./batches";
import { JobTable } from "./jobs";
import { State } from "./scans";

export function BatchPage({ id }: { id: string }) {
  const { batch, problem } = useBatch(id);
  const jobs = useAnswer<JobPage>(
    batch && `/v1/jobs?batch_id=${encodeURIComponent(id)}`,
    JSON.stringify([batch?.state, batch?.counts]),
  );
  useTitle(batch?.label ?? t("batch"));
  if (problem) return <ProblemNote problem={missingOf(problem, "batch_not_found")} />;
  if (!batch) return <Loading />;
  const ended = Object.entries(batch.counts)
    .filter(([state]) => !["queued", "running", "canceling"].includes(state))
    .reduce((sum, [, n]) => sum + n, 0);
  return (
    <>
      <h1>{t("batch")}: {batch.label ?? batch.id}</h1>
      <progress value={ended} max={batch.n_jobs} aria-label={t("progress")} />
      <Facts
        facts={[
          [t("state"), <State of={batch.state} group="batch_state" />],
          [t("progress"), countsInWords(batch)],
          [t("remaining"), batch.eta_s != null ? duration(batch.eta_s) : "–"],
          [t("created_at"), time(batch.created_at)],
          [t("finished_at"), time(batch.finished_at)],
        ]}
      />
      <div class="actions">
        <DownloadButton path={`/v1/batches/${id}/figures.csv`} label={t("figures_table")} />
        {batch.state === "ended" ? (
          <>
            <DownloadButton path={`/v1/batches/${id}/results.zip`} label={t("all_results")} />
            <ActionButton
              label={t("rerun_failed")}
              work={async () => go(`/batches/${(await post<Batch>(`/v1/batches/${id}/rerun`)).id}`)}
            />
          </>
        ) : (
          <ActionButton label={t("cancel")} work={async () => void (await post(`/v1/batches/${id}/cancel`))} />
        )}
        <a href={`#/jobs?batch_id=${id}`}>{t("all_jobs")}</a>
      </div>
      <ProblemNote problem={jobs.problem} />
      {jobs.value && <JobTable jobs={jobs.value.items} />}
    </>
  );
}

function useBatch(id: string): { batch: Batch | null; problem: Problem | null } {
  const [batch, setBatch] = useState<Batch | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    const following = new AbortController();
    const look = async () => setBatch(await get<Batch>(`/v1/batches/${id}`, { signal: following.signal }));
    const fail = (error: unknown) => {
      if (!following.signal.aborted) setProblem(asProblem(error));
    };
    look()
      .then(() => readEvents(`/v1/batches/${id}/events`, () => void look().catch(fail), following.signal))
      .then(look)
      .catch(fail);
    return () => following.abort();
  }, [id]);
  return { batch, problem };
}
