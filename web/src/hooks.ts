/** What pages have in common: answers of the service that are asked for once, or again and again. */
import { useCallback, useEffect, useState } from "preact/hooks";
import { get } from "./api/client";
import { asProblem, type Problem } from "./api/problem";

export interface Answer<T> {
  value: T | null;
  problem: Problem | null;
  reload: () => void;
}

/** Ask for a path when it or `version` changes, and on `reload`; with null nothing is asked. */
export function useAnswer<T>(path: string | null, version = ""): Answer<T> {
  const [state, setState] = useState<{ path: string | null; value: T | null; problem: Problem | null }>({
    path: null,
    value: null,
    problem: null,
  });
  const [round, setRound] = useState(0);
  useEffect(() => {
    if (path === null) return;
    const asking = new AbortController();
    get<T>(path, { signal: asking.signal })
      .then((value) => setState({ path, value, problem: null }))
      .catch((error: unknown) => {
        if (!asking.signal.aborted) setState({ path, value: null, problem: asProblem(error) });
      });
    return () => asking.abort();
  }, [path, version, round]);
  const reload = useCallback(() => setRound((n) => n + 1), []);
  const isOfPath = state.path === path;
  return { value: isOfPath ? state.value : null, problem: isOfPath ? state.problem : null, reload };
}

export interface Action {
  isBusy: boolean;
  problem: Problem | null;
  run: (work: () => Promise<void>) => Promise<void>;
}

/** Something that a button does: whether it is under way, and why it failed. */
export function useAction(): Action {
  const [isBusy, setBusy] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const run = useCallback(async (work: () => Promise<void>) => {
    setBusy(true);
    setProblem(null);
    try {
      await work();
    } catch (error) {
      setProblem(asProblem(error));
    } finally {
      setBusy(false);
    }
  }, []);
  return { isBusy, problem, run };
}

export function useTitle(title: string): void {
  useEffect(() => {
    document.title = title ? `${title} · Quadpatch` : "Quadpatch";
  }, [title]);
}
