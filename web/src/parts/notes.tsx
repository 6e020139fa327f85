/** Errors and notes in words. */
import type { ComponentChildren } from "preact";
import type { Problem } from "../api/problem";
import { hasText, t } from "../text/text";

/** Codes whose sentence says all: what the service says besides would only repeat it in English. */
const SAID = new Set([
  "unauthorized", "tenant_disabled", "empty_file", "unreachable",
  "page_not_found", "mesh_not_found", "job_not_found", "batch_not_found",
]);

/** What went wrong: a sentence on the code in the reader's language, and what the service says of this case. */
export function ProblemNote({ problem }: { problem: Problem | null }) {
  if (problem === null) return null;
  const key = `problem_${problem.code}`;
  const sentence = hasText(key) ? t(key) : t("problem_other");
  const fields = problem.document?.errors ?? [];
  return (
    <div class="note error" role="alert">
      <p><strong>{sentence}</strong></p>
      {problem.detail && !SAID.has(problem.code) && <p>{t("service_says")}: <span lang="en">{problem.detail}</span></p>}
      {fields.length > 0 && (
        <ul lang="en">{fields.map((field) => <li key={field.pointer}>{field.pointer}: {field.message}</li>)}</ul>
      )}
    </div>
  );
}

/** A mesh or a job that failed: its code in words. */
export function FailureNote({ code, message }: { code: string; message: string }) {
  const key = `failure_${code}`;
  return (
    <div class="note error" role="alert">
      <p><strong>{hasText(key) ? t(key) : t("failure_other")}</strong></p>
      <p>{t("service_says")}: <span lang="en">{message}</span></p>
    </div>
  );
}

export function Note({ children }: { children: ComponentChildren }) {
  return <div class="note">{children}</div>;
}

export function Loading() {
  return <p role="status">{t("loading")}</p>;
}
