/** A mesh until its analysis has ended, and a job until it has. */
import { useEffect, useState } from "preact/hooks";
import { get } from "./client";
import { pause, readEvents } from "./events";
import { asProblem, type Problem } from "./problem";
import type { Event, Job, JobState, Mesh } from "./types";

const LOOK_MS = 3000;
const ENDED: readonly JobState[] = ["succeeded", "succeeded_with_warnings", "failed", "canceled"];

export function hasEnded(job: Job): boolean {
  return ENDED.includes(job.state);
}

export function hasResult(job: Job): boolean {
  return job.state === "succeeded" || job.state === "succeeded_with_warnings";
}

export function useMesh(id: string): { mesh: Mesh | null; problem: Problem | null } {
  const [mesh, setMesh] = useState<Mesh | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    const asking = new AbortController();
    const look = async (): Promise<void> => {
      for (let wait = 0; !asking.signal.aborted; wait = 10) {
        const found = await get<Mesh>(`/v1/meshes/${id}?wait=${wait}`, { signal: asking.signal });
        setMesh(found);
        if (found.state !== "analysing") return;
      }
    };
    look().catch((error: unknown) => {
      if (!asking.signal.aborted) setProblem(asProblem(error));
    });
    return () => asking.abort();
  }, [id]);
  return { mesh, problem };
}

/**
 * Follow a job: events say stage and percent at once, and the job itself is looked at when it changes.
 *
 * Its place in the queue has no events, so it is also asked for every few seconds.
 */
export function useJob(id: string): { job: Job | null; problem: Problem | null } {
  const [job, setJob] = useState<Job | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    const following = new AbortController();
    const { signal } = following;
    const look = async (): Promise<Job> => {
      const found = await get<Job>(`/v1/jobs/${id}`, { signal });
      setJob((known) => (known && known.revision > found.revision ? known : found));
      return found;
    };
    const fail = (error: unknown) => {
      if (!signal.aborted) setProblem(asProblem(error));
    };
    const onEvent = (event: Event) => {
      const { stage, percent } = event.data ?? {};
      if (event.type === "progress")
        setJob((known) => known && { ...known, stage: stage ?? known.stage ?? null, percent: percent ?? known.percent });
      else look().catch(fail);
    };
    const lookAgain = async () => {
      while (!signal.aborted && !hasEnded(await look())) await pause(LOOK_MS, signal);
    };
    lookAgain().catch(fail);
    // Where there are too many streams already, looking is enough.
    readEvents<Event>(`/v1/jobs/${id}/events`, onEvent, signal)
      .then(look)
      .catch(() => undefined);
    return () => following.abort();
  }, [id]);
  return { job, problem };
}
