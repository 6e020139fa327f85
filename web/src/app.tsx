/** The frame around all pages: what there is, who is asking, the language; and which page is shown. */
import type { ComponentType } from "preact";
import { useEffect, useReducer, useRef, useState } from "preact/hooks";
import { get } from "./api/client";
import { asProblem, Problem } from "./api/problem";
import type { Limits } from "./api/types";
import { AboutPage } from "./pages/about";
import { BatchPage } from "./pages/batch";
import { BatchesPage } from "./pages/batches";
import { JobPage } from "./pages/job";
import { JobsPage } from "./pages/jobs";
import { KeysPage } from "./pages/keys";
import { LoginPage } from "./pages/login";
import { MeshPage } from "./pages/mesh";
import { ModelsPage } from "./pages/models";
import { RulesPage } from "./pages/rules";
import { ScansPage } from "./pages/scans";
import { Loading, ProblemNote } from "./parts/notes";
import { useRoute } from "./route";
import { forgetKey, key, onKeyChange } from "./session";
import { type Language, language, onLanguageChange, setLanguage, t } from "./text/text";

const SECTIONS = ["scans", "jobs", "batches", "models", "rules", "keys", "about"] as const;
type Section = (typeof SECTIONS)[number];
const LISTS: Record<Section, ComponentType> = {
  scans: ScansPage,
  jobs: JobsPage,
  batches: BatchesPage,
  models: ModelsPage,
  rules: RulesPage,
  keys: KeysPage,
  about: AboutPage,
};

export function App() {
  const [, redraw] = useReducer((n: number, _: void) => n + 1, 0);
  const access = useAccess();
  useEffect(() => onLanguageChange(() => redraw()), []);
  return (
    <>
      <a class="skip" href="#main" onClick={(event) => (event.preventDefault(), document.getElementById("main")?.focus())}>
        {t("skip_to_content")}
      </a>
      <Header isOpen={access.state === "open"} />
      <Main access={access} />
    </>
  );
}

interface Access {
  state: "asking" | "open" | "closed" | "failed";
  problem: Problem | null;
}

/** Whether the service answers: without a key, with the one of this session, or not at all. */
function useAccess(): Access {
  const [access, setAccess] = useState<Access>({ state: "asking", problem: null });
  const [round, askAgain] = useReducer((n: number, _: void) => n + 1, 0);
  useEffect(() =>
    onKeyChange(() => {
      // Who signs out sees nothing more of the service, however long it takes to answer.
      if (key() === null) setAccess({ state: "asking", problem: null });
      askAgain();
    }), []);
  useEffect(() => {
    let isLatest = true;
    const show = (access: Access) => isLatest && setAccess(access);
    get<Limits>("/v1/limits")
      .then(() => show({ state: "open", problem: null }))
      .catch((error: unknown) => {
        const problem = asProblem(error);
        show({ state: problem.status === 401 ? "closed" : "failed", problem });
      });
    return () => {
      isLatest = false;
    };
  }, [round]);
  return access;
}

function Header({ isOpen }: { isOpen: boolean }) {
  const route = useRoute();
  const [first] = route.parts;
  const section = first === "meshes" ? "scans" : sectionOf(first);
  return (
    <header>
      <a class="brand" href="#/scans">Quadpatch</a>
      {isOpen && (
        <nav aria-label={t("sections")}>
          {SECTIONS.map((name) => (
            <a key={name} href={`#/${name}`} aria-current={section === name ? "page" : undefined}>
              {t(`section_${name}`)}
            </a>
          ))}
        </nav>
      )}
      <span class="grow" />
      <select
        aria-label={t("language")}
        value={language()}
        onChange={(event) => setLanguage(event.currentTarget.value as Language)}
      >
        <option value="en" lang="en">English</option>
        <option value="de" lang="de">Deutsch</option>
      </select>
      {isOpen && key() !== null && <button type="button" onClick={forgetKey}>{t("sign_out")}</button>}
    </header>
  );
}

function Main({ access }: { access: Access }) {
  const route = useRoute();
  const main = useRef<HTMLElement>(null);
  const path = route.parts.join("/");
  const shown = useRef(path);
  // A screen reader goes on at the new page, as after a link to another document.
  useEffect(() => {
    if (shown.current !== path) main.current?.focus();
    shown.current = path;
  }, [path]);
  return (
    <main id="main" ref={main} tabIndex={-1}>
      {access.state === "asking" && <Loading />}
      {access.state === "failed" && <ProblemNote problem={access.problem} />}
      {access.state === "closed" && <LoginPage />}
      {access.state === "open" && <Page parts={route.parts} />}
    </main>
  );
}

function Page({ parts: [first, id] }: { parts: string[] }) {
  if (first === "meshes" && id) return <MeshPage key={id} id={id} />;
  if (first === "jobs" && id) return <JobPage key={id} id={id} />;
  if (first === "batches" && id) return <BatchPage key={id} id={id} />;
  const section = id ? undefined : sectionOf(first);
  if (!section) return <ProblemNote problem={new Problem("page_not_found", "", 404)} />;
  const List = LISTS[section];
  return <List />;
}

/** The part of the page that an address names first; an empty one is that of the scans. */
function sectionOf(first = "scans"): Section | undefined {
  return SECTIONS.find((name) => name === first);
}
