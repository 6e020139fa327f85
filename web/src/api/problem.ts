/** What the service refused, and what went wrong on the way to it. */
import type { ProblemDocument } from "./types";

export class Problem extends Error {
  /** `code` is that of the problem document, or `unreachable` where no answer came. */
  constructor(
    readonly code: string,
    readonly detail: string,
    readonly status: number,
    readonly document: ProblemDocument | null = null,
  ) {
    super(detail);
  }
}

export async function problemOf(response: Response): Promise<Problem> {
  const text = await response.text();
  return problemOfText(text, response.status);
}

/** Read a problem document; an answer of something in between, such as a proxy, has another form. */
export function problemOfText(text: string, status: number): Problem {
  try {
    const document = JSON.parse(text) as ProblemDocument;
    if (typeof document.code === "string") return new Problem(document.code, document.detail, status, document);
  } catch {
    // No JSON: told below.
  }
  return new Problem("http_error", `HTTP ${status}`, status);
}

/** Where the id in an address is none, such as `job_nope`, nothing has it. */
export function missingOf(problem: Problem, code: "mesh_not_found" | "job_not_found" | "batch_not_found"): Problem {
  return problem.status === 422 ? new Problem(code, "", 404) : problem;
}

export function asProblem(error: unknown): Problem {
  if (error instanceof Problem) return error;
  if (error instanceof TypeError) return new Problem("unreachable", error.message, 0);
  return new Problem("page_error", error instanceof Error ? error.message : String(error), 0);
}
