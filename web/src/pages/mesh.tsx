/** One scan: its holes in 3D and as a list, what is to be done with each, and the start of a repair. */
import { useEffect, useMemo, useState } from "preact/hooks";
import { post, send } from "../api/client";
import { useMesh } from "../api/following";
import { asProblem, missingOf, type Problem } from "../api/problem";
import type { Hole, Job, JobSpec, Mesh, Plan } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { type Action, type Choices, choicesOf, type HoleRow, withChoice } from "../holes";
import { ActionButton, DownloadButton, Facts } from "../parts/forms";
import { HoleList } from "../parts/hole_list";
import { FailureNote, Loading, ProblemNote, WarningNotes } from "../parts/notes";
import { draftOf, draftSpec, type Draft, EMPTY_DRAFT, RepairForm } from "../parts/repair_form";
import { go, useRoute } from "../route";
import { bytes, count, length, unitName } from "../text/format";
import { t, tCode } from "../text/text";
import { Workspace } from "../viewer/workspace";

const PLAN_DELAY_MS = 300;

export function MeshPage({ id }: { id: string }) {
  const { mesh, problem } = useMesh(id);
  const [choices, setChoices] = useState<Choices>(new Map());
  const [draft, setDraft] = useState<Draft>(EMPTY_DRAFT);
  const { query } = useRoute();
  const former = useAnswer<Job>(query.has("job") ? `/v1/jobs/${query.get("job")}` : null).value;
  useEffect(() => {
    if (!former) return;
    setDraft(draftOf(former.spec));
    if (!former.spec.rule) setChoices(choicesOf(former.spec.holes?.rules ?? []));
  }, [former]);
  const unit = mesh?.facts?.unit ?? draft.unit ?? null;
  const diagonal = mesh?.facts?.diagonal ?? null;
  const spec = useMemo(() => draftSpec(id, draft, choices), [id, draft, choices]);
  const { plan, planProblem } = usePlan(spec, mesh);
  const holes = useMemo(() => rows(mesh, plan), [mesh, plan]);
  useTitle(mesh?.filename ?? t("scan"));
  if (problem) return <ProblemNote problem={missingOf(problem, "mesh_not_found")} />;
  if (!mesh) return <Loading />;
  const choose = draft.rule ? undefined : (hole: number, action: Action) => setChoices(withChoice(choices, hole, action));
  return (
    <>
      <h1>{mesh.filename ?? mesh.id.slice(0, 12)}</h1>
      {mesh.problem && <FailureNote {...mesh.problem} />}
      {mesh.state !== "rejected" && (
        <Workspace
          before={`/v1/meshes/${id}/view`}
          outlines={mesh.state === "ready" ? `/v1/meshes/${id}/outlines` : null}
          holes={holes}
          unit={unit}
          choices={choices}
          onChoose={choose}
          list={(selected, onSelect) => (
            <>
              <h2>{t("holes")}{mesh.facts && ` (${count(mesh.facts.holes.length)})`}</h2>
              {mesh.state === "analysing" && <p role="status">{t("analysing")}</p>}
              {mesh.state === "ready" && (
                <HoleList {...{ holes, unit, diagonal, selected, onSelect, choices }} {...(choose ? { onChoose: choose } : {})} />
              )}
            </>
          )}
        >
          <RepairForm draft={draft} onChange={setDraft} mesh={mesh} spec={spec} plan={plan} hasChoices={choices.size > 0} />
          <ProblemNote problem={planProblem} />
        </Workspace>
      )}
      <MeshFacts mesh={mesh} unit={unit} />
    </>
  );
}

function MeshFacts({ mesh, unit }: { mesh: Mesh; unit: string | null }) {
  const { facts } = mesh;
  const lines: [string, string][] = [[t("size"), bytes(mesh.size_bytes)]];
  const remove = async () => {
    await send("DELETE", `/v1/meshes/${mesh.id}`);
    go("/scans");
  };
  if (facts?.format) lines.push([t("format"), facts.format]);
  if (facts?.triangles != null) lines.push([t("triangles"), count(facts.triangles)]);
  if (facts?.vertices != null) lines.push([t("vertices"), count(facts.vertices)]);
  if (facts) lines.push([t("diagonal"), length(facts.diagonal, unit)], [t("unit"), unit ? unitName(unit) : t("unit_not_stated")]);
  return (
    <section>
      <h2>{t("about_scan")}</h2>
      <Facts facts={lines} />
      <WarningNotes details={facts?.warning_details} warnings={facts?.warnings} />
      <p class="actions">
        <DownloadButton path={`/v1/meshes/${mesh.id}/content`} label={t("download_scan")} />
        <a href={`#/jobs?mesh_id=${mesh.id}`}>{t("jobs_of_scan")}</a>
        <ActionButton label={t("delete_scan")} work={remove} confirm={t("delete_scan_sure")} />
      </p>
    </section>
  );
}

/** What the repair would do: asked for again a moment after each change. */
function usePlan(spec: JobSpec, mesh: Mesh | null): { plan: Plan | null; planProblem: Problem | null } {
  const [plan, setPlan] = useState<Plan | null>(null);
  const [planProblem, setProblem] = useState<Problem | null>(null);
  const isReady = mesh?.state === "ready" && !mesh.facts?.encoded;
  useEffect(() => {
    if (!isReady) return;
    const asking = new AbortController();
    const ask = () =>
      post<Plan>("/v1/jobs?dry_run=true", spec, { signal: asking.signal })
        .then((found) => (setPlan(found), setProblem(null)))
        .catch((error: unknown) => {
          if (!asking.signal.aborted) setProblem(asProblem(error));
        });
    const timer = setTimeout(() => void ask(), PLAN_DELAY_MS);
    return () => (clearTimeout(timer), asking.abort());
  }, [spec, isReady]);
  return { plan, planProblem };
}

function rows(mesh: Mesh | null, plan: Plan | null): HoleRow[] {
  const planned = new Map(plan?.holes.map((hole) => [hole.id, hole]));
  return (mesh?.facts?.holes ?? []).map((hole: Hole): HoleRow => {
    const plan = planned.get(hole.id);
    const action = plan?.selected ? t(`plan_${plan.action ?? "model"}`) : t("plan_open", { why: tCode("reason", plan?.reason ?? "") });
    return {
      id: hole.id,
      kind: hole.kind ?? "hole",
      diameter: hole.diameter,
      perimeter: hole.perimeter,
      centre: hole.centre ?? null,
      note: plan ? action : "",
      isOpen: plan ? !plan.selected : true,
    };
  });
}
