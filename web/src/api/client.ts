/** Requests to the service. All go to the machine that the page came from, with the key of the session. */
import { forgetKey, keyHeader } from "../session";
import { problemOf } from "./problem";

interface Options {
  signal?: AbortSignal;
  headers?: Record<string, string>;
}

/** Send a request; raise Problem where the answer is an error. A key that is refused is forgotten. */
export async function send(method: string, path: string, body?: unknown, options: Options = {}): Promise<Response> {
  const headers: Record<string, string> = { ...keyHeader(), ...options.headers };
  if (body !== undefined) headers["Content-Type"] = "application/json";
  const response = await fetch(path, {
    method,
    headers,
    body: body === undefined ? null : JSON.stringify(body),
    signal: options.signal ?? null,
    cache: "no-store",
  });
  if (response.ok) return response;
  if (response.status === 401) forgetKey();
  throw await problemOf(response);
}

export async function get<T>(path: string, options?: Options): Promise<T> {
  return (await send("GET", path, undefined, options)).json() as Promise<T>;
}

export async function post<T>(path: string, body?: unknown, options?: Options): Promise<T> {
  return (await send("POST", path, body, options)).json() as Promise<T>;
}

export async function getBytes(path: string, options?: Options): Promise<ArrayBuffer> {
  return (await send("GET", path, undefined, options)).arrayBuffer();
}

/** A path with a query; what is empty is left out, lists are repeated. */
export function withQuery(path: string, query: Record<string, string | string[] | null | undefined>): string {
  const search = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    for (const item of Array.isArray(value) ? value : [value]) if (item) search.append(name, item);
  }
  const text = search.toString();
  return text ? `${path}?${text}` : path;
}

/** Save what a path answers as a file: with the key, which a plain link could not send. */
export async function download(path: string): Promise<void> {
  const response = await send("GET", path);
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await response.blob());
  link.download = fileName(response, path);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

function fileName(response: Response, path: string): string {
  const header = response.headers.get("Content-Disposition") ?? "";
  const encoded = /filename\*=UTF-8''([^;]+)/i.exec(header)?.[1];
  if (encoded) return decodeURIComponent(encoded);
  return /filename="([^"]+)"/.exec(header)?.[1] ?? path.split("/").at(-1) ?? "download";
}
