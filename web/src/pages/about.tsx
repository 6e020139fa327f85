/** What runs here, and what limits the caller. */
import type { Limits, Version } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { Facts } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { bytes, count, duration } from "../text/format";
import { t } from "../text/text";

export function AboutPage() {
  const version = useAnswer<Version>("/v1/version");
  const limits = useAnswer<Limits>("/v1/limits");
  useTitle(t("section_about"));
  return (
    <>
      <h1>{t("about_title")}</h1>
      <p>{t("about_what")}</p>
      <ProblemNote problem={version.problem ?? limits.problem} />
      {(!version.value || !limits.value) && !version.problem && !limits.problem && <Loading />}
      {version.value && (
        <Facts
          facts={[
            [t("version"), version.value.version],
            [t("api_version"), version.value.api],
            ["Python", version.value.python],
          ]}
        />
      )}
      {limits.value && <LimitsFacts limits={limits.value} />}
      <h2>{t("shortcuts")}</h2>
      <Facts
        facts={[
          ["N, P", t("shortcut_next")],
          ["F, S, X, L, A", t("shortcut_choose")],
          [t("arrow_keys"), t("shortcut_turn")],
          ["+, −", t("shortcut_zoom")],
          ["0", t("shortcut_all")],
          ["M, Enter", t("shortcut_measure")],
                  ]}
      />
      <h2>{t("more")}</h2>
      <ul>
        <li><a href="/docs">{t("api_docs")}</a></li>
        <li><a href="/page/licences.txt">{t("licences")}</a></li>
      </ul>
    </>
  );
}

function LimitsFacts({ limits }: { limits: Limits }) {
  const { quotas, use, jobs } = limits;
  const of = (used: number, limit: number | undefined, write: (n: number) => string) =>
    `${write(used)} ${limit ? t("out_of", { limit: write(limit) }) : t("no_limit")}`;
  return (
    <>
      <h2>{t("limits")}</h2>
      <Facts
        facts={[
          [t("tenant"), limits.tenant],
          [t("largest_file"), bytes(limits.bodies.mesh)],
          [t("stored"), of(use.stored_bytes, quotas.stored_bytes, bytes)],
          [t("jobs_waiting"), of(use.jobs_waiting, quotas.jobs_waiting, count)],
          [t("jobs_at_work"), of(use.jobs_at_work, quotas.jobs_at_once, count)],
          [t("requests"), quotas.requests_per_minute ? count(quotas.requests_per_minute) : t("no_limit")],
          [t("job_time"), duration(jobs.time_s)],
          [t("job_memory"), bytes(jobs.memory_mb * 1024 * 1024)],
          [t("formats_read"), limits.formats_read.join(", ")],
          [t("formats_written"), limits.formats_written.join(", ")],
        ]}
      />
    </>
  );
}
