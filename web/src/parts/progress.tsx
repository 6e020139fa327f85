/** How far a job is: its place among those that wait, its stage, percent and remaining time. */
import { post } from "../api/client";
import type { Job } from "../api/types";
import { duration, percent } from "../text/format";
import { t, tCode } from "../text/text";
import { ActionButton } from "./forms";

export function Progress({ job }: { job: Job }) {
  return (
    <section class="card" aria-label={t("progress")}>
      <progress value={job.percent} max={100} aria-label={t("progress")} />
      <p role="status">{inWords(job)}</p>
      <ActionButton label={t("cancel")} work={async () => void (await post(`/v1/jobs/${job.id}/cancel`))} />
    </section>
  );
}

function inWords(job: Job): string {
  const parts: string[] = [];
  if (job.queue_position != null) parts.push(t("queue_position", { n: job.queue_position }));
  if (job.waits_for) parts.push(t("waits_for_memory"));
  if (job.state === "running") parts.push(percent(job.percent / 100));
  if (job.stage) parts.push(tCode("stage", job.stage));
  if (job.eta_s != null) parts.push(`${t("remaining")}: ${duration(job.eta_s)}`);
  return parts.join(" · ");
}
