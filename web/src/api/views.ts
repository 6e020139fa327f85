/** Views that a worker makes when they are asked for first: the request is repeated until they are there. */
import { send } from "./client";
import { pause } from "./events";

/** Return the answer once the view was made; raise Problem where it can't be. */
export async function view(path: string, signal: AbortSignal): Promise<Response> {
  for (;;) {
    const response = await send("GET", path, undefined, { headers: { Prefer: "wait=10" }, signal });
    if (response.status !== 202) return response;
    await pause(1000 * Number(response.headers.get("Retry-After") ?? 1), signal);
    signal.throwIfAborted();
  }
}
