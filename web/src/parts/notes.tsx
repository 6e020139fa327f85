/** Errors and notes in words. */
import type { ComponentChildren } from "preact";
import type { Problem } from "../api/problem";
import type { WarningDetail } from "../api/types";
import { hasText, language, t, tService, type Values } from "../text/text";

/** Codes whose sentence says all: what the service says besides would only repeat it in English. */
const SAID = new Set([
  "unauthorized", "tenant_disabled", "empty_file", "unreachable",
  "page_not_found", "mesh_not_found", "job_not_found", "batch_not_found",
]);

/** What went wrong: a sentence on the code in the reader's language, and what the service says of this case. */
export function ProblemNote({ problem }: { problem: Problem | null }) {
  if (problem === null) return null;
  const fields = problem.document?.errors ?? [];
  return (
    <div class="note error" role="alert">
      <Sentence group="problem" code={problem.code} message={SAID.has(problem.code) ? "" : problem.detail} />
      {fields.length > 0 && (
        <ul>
          {fields.map(({ pointer, code, message, values }) => (
            <li key={pointer}><code>{pointer}</code>: {tService("field", code, values ?? {}) ?? <span lang="en">{message}</span>}</li>
          ))}
        </ul>
      )}
    </div>
  );
}

/** A code in the reader's language, and what the service says of this case. */
function Sentence({ group, code, message }: { group: "problem" | "failure"; code: string; message: string }) {
  const key = `${group}_${code}`;
  const own = hasText(key) ? t(key) : tService(group, code);
  return (
    <>
      <p><strong>{own ?? t(`${group}_other`)}</strong></p>
      <Wording group={group} code={code} message={message} />
    </>
  );
}

/** The service's own words: open where they say what nothing else does, else to be opened by who reads English. */
function Wording({ group, code, message, values }: { group: "problem" | "failure" | "warning"; code: string; message: string; values?: Values }) {
  if (!message) return null;
  const words = <span lang="en">{message}</span>;
  if (tService(group, code, values) === null) return <p>{t("service_says")}: {words}</p>;
  return <details><summary>{t("wording")}</summary><p>{words}</p></details>;
}

/** A text in English that others wrote: open for who reads English, else to be opened. */
export function EnglishText({ text, summary }: { text: string; summary: string }) {
  if (language() === "en") return <p>{text}</p>;
  return <details><summary>{summary}</summary><p lang="en">{text}</p></details>;
}

/** Warnings in the reader's language; those of earlier versions have no codes, and stand as they are. */
export function WarningNotes({ details = [], warnings = [] }: { details?: WarningDetail[] | undefined; warnings?: string[] | undefined }) {
  const coded = details.length > 0 ? details : warnings.map((message) => ({ code: "other", message, values: {} }));
  return (
    <>
      {coded.map(({ code, message, values = {} }) => {
        const own = tService("warning", code, values);
        return (
          <Note key={message}>
            {own === null ? <span lang="en">{message}</span> : <p>{own}</p>}
            {own !== null && <Wording group="warning" code={code} message={message} values={values} />}
          </Note>
        );
      })}
    </>
  );
}

/** A mesh or a job that failed: its code in words. */
export function FailureNote({ code, message }: { code: string; message: string }) {
  return <div class="note error" role="alert"><Sentence group="failure" code={code} message={message} /></div>;
}

export function Note({ children }: { children: ComponentChildren }) {
  return <div class="note">{children}</div>;
}

export function Loading() {
  return <p role="status">{t("loading")}</p>;
}
