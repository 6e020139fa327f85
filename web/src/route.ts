/** Which page is shown: the part of the address behind `#`, as in `#/jobs/job_01?state=failed`. */
import { useEffect, useState } from "preact/hooks";

export interface Route {
  /** Parts of the path: `["jobs", "job_01"]`. */
  parts: string[];
  query: URLSearchParams;
}

export function currentRoute(): Route {
  const [path = "", query = ""] = location.hash.replace(/^#\/?/, "").split("?");
  return { parts: decoded(path), query: new URLSearchParams(query) };
}

/** Parts of a path. What is not well coded, such as `%`, is one part that names no page. */
function decoded(path: string): string[] {
  try {
    return path.split("/").filter(Boolean).map(decodeURIComponent);
  } catch {
    return [path];
  }
}

export function useRoute(): Route {
  const [route, setRoute] = useState(currentRoute);
  useEffect(() => {
    const follow = () => setRoute(currentRoute());
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, []);
  return route;
}

export function go(path: string): void {
  location.hash = path;
}
