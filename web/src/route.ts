/** Which page is shown: the part of the address behind `#`, as in `#/jobs/job_01?state=failed`. */
import { useEffect, useState } from "preact/hooks";

export interface Route {
  /** Parts of the path: `["jobs", "job_01"]`. */
  parts: string[];
  query: URLSearchParams;
}

export function currentRoute(): Route {
  const [path = "", query = ""] = location.hash.replace(/^#\/?/, "").split("?");
  return { parts: path.split("/").filter(Boolean).map(decodeURIComponent), query: new URLSearchParams(query) };
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
