/** One job: its stages while it works, then before and after in 3D, each hole with its verdict, and the files. */
import { useMemo, useState } from "preact/hooks";
import { post, send } from "../api/client";
import { hasEnded, hasResult, useJob } from "../api/following";
import { missingOf } from "../api/problem";
import type { FillReport, HoleReport, Job } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { type HoleRow, isLeftOpen } from "../holes";
import { DropZone } from "../parts/dropzone";
import { ActionButton, DownloadButton, Facts } from "../parts/forms";
import { HoleList } from "../parts/hole_list";
import { FailureNote, Loading, ProblemNote, WarningNotes } from "../parts/notes";
import { Outcome } from "../parts/outcome";
import { Progress } from "../parts/progress";
import { go } from "../route";
import { count, diagonalOf, duration, time } from "../text/format";
import { t, tCode } from "../text/text";
import { Workspace } from "../viewer/workspace";
import { State } from "./scans";

export function JobPage({ id }: { id: string }) {
  const { job, problem } = useJob(id);
  const isFill = job !== null && hasResult(job) && (job.spec.task ?? "fill") === "fill";
  const report = useAnswer<FillReport>(isFill ? `/v1/jobs/${id}/report` : null);
  useTitle(job?.mesh_name ?? t("job"));
  if (problem) return <ProblemNote problem={missingOf(problem, "job_not_found")} />;
  if (!job) return <Loading />;
  return (
    <>
      <h1>{job.mesh_name ?? job.id}</h1>
      <p><State of={job.state} group="job_state" /> {job.spec.label}</p>
      {!hasEnded(job) && <Progress job={job} />}
      {job.error && <FailureNote {...job.error} />}
      {report.value && <Outcome holes={report.value.holes} />}
      <WarningNotes details={job.result?.warning_details} warnings={job.result?.warnings} />
      {hasResult(job) && <Downloads job={job} />}
      <ProblemNote problem={report.problem} />
      {isFill && <Repaired job={job} report={report.value} />}
      <JobFacts job={job} />
    </>
  );
}

function Downloads({ job }: { job: Job }) {
  const { links } = job;
  const files: [string | null | undefined, string][] = [
    [links.result, t("download_result", { format: job.result?.format ?? "" })],
    [links.html_report, t("download_html_report")],
    [links.report, t("download_report")],
    [links.preview, t("download_preview")],
    [links.closeups, t("download_closeups")],
  ];
  return (
    <div class="actions" role="group" aria-label={t("download")}>
      {files.map(([path, label]) => path && <DownloadButton key={path} path={path} label={label} />)}
    </div>
  );
}

function Repaired({ job, report }: { job: Job; report: FillReport | null }) {
  const [reference, setReference] = useState<string | null>(null);
  const holes = useMemo(() => (report ? rows(report) : []), [report]);
  const unit = report?.length_unit;
  const diagonal = report && diagonalOf(report.source.bounding_box);
  return (
    <Workspace
      before={`/v1/meshes/${job.mesh_id}/view`}
      after={`/v1/jobs/${job.id}/view`}
      reference={reference}
      outlines={`/v1/meshes/${job.mesh_id}/outlines`}
      holes={holes}
      unit={unit}
      list={(selected, onSelect) => (
        <>
          <h2>{t("holes")}{report && ` (${count(holes.length)})`}</h2>
          {report ? <HoleList {...{ holes, unit, diagonal, selected, onSelect }} /> : <Loading />}
        </>
      )}
    >
      <section>
        <h2>{t("reference")}</h2>
        <p>{t("reference_why")}</p>
        <DropZone label={t("drop_reference")} isSmall onMesh={setReference} />
      </section>
    </Workspace>
  );
}

function rows({ holes, acceptance }: FillReport): HoleRow[] {
  const unmet = new Set(acceptance?.unmet?.map(({ id }) => id));
  return holes.map((hole) => ({ ...row(hole), isUnmet: unmet.has(hole.id) }));
}

function row(hole: HoleReport): HoleRow {
  const why = hole.code ? `: ${tCode("reason", hole.code)}` : "";
  return {
    id: hole.id,
    kind: hole.kind,
    diameter: hole.diameter,
    perimeter: hole.perimeter,
    centre: hole.centre,
    note: `${tCode("verdict", hole.verdict)}${why}`,
    isOpen: isLeftOpen(hole),
    confidence: hole.confidence,
    expectedError: hole.expected_error,
  };
}

function JobFacts({ job }: { job: Job }) {
  const { method } = job.spec;
  const remove = async () => {
    await send("DELETE", `/v1/jobs/${job.id}`);
    go("/jobs");
  };
  const effort = method?.method === "auto" ? t(`effort_${method.effort ?? "standard"}`) : null;
  return (
    <section>
      <h2>{t("about_job")}</h2>
      <Facts
        facts={[
          [t("job"), <code>{job.id}</code>],
          [t("task"), tCode("task", job.spec.task ?? "fill")],
          [t("method"), effort ?? tCode("method", method?.method ?? "auto")],
          [t("rule"), job.spec.rule ?? "–"],
          [t("created_at"), time(job.created_at)],
          [t("finished_at"), time(job.finished_at)],
          [t("work_time"), job.result?.seconds != null ? duration(job.result.seconds) : "–"],
        ]}
      />
      <div class="actions">
        <a href={`#/meshes/${job.mesh_id}?job=${job.id}`}>{t("to_scan")}</a>
        {hasEnded(job) && (
          <ActionButton
            label={t("rerun")}
            work={async () => go(`/jobs/${(await post<Job>(`/v1/jobs/${job.id}/rerun`)).id}`)}
          />
        )}
        {hasEnded(job) && <ActionButton label={t("delete_job")} work={remove} confirm={t("delete_job_sure")} />}
      </div>
    </section>
  );
}
