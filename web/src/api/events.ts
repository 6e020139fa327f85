/**
 * A job, a batch or a mesh until it has ended.
 *
 * Events are read by `fetch`, since `EventSource` sends no key. A stream that breaks goes on behind the last event.
 */
import { EventSourceParserStream } from "eventsource-parser/stream";
import { send } from "./client";
import { asProblem } from "./problem";

const PAUSE_MS = 1000;

/** Call `onEvent` with each event of a stream, past ones first, until it has ended; raise Problem if refused. */
export async function readEvents<T>(path: string, onEvent: (event: T) => void, signal: AbortSignal): Promise<void> {
  let last = "";
  while (!signal.aborted) {
    try {
      const headers: Record<string, string> = { Accept: "text/event-stream" };
      if (last) headers["Last-Event-ID"] = last;
      const response = await send("GET", path, undefined, { headers, signal });
      if (response.status === 204 || response.body === null) return;
      const reader = response.body
        .pipeThrough(new TextDecoderStream())
        .pipeThrough(new EventSourceParserStream())
        .getReader();
      for (let part = await reader.read(); !part.done; part = await reader.read()) {
        last = part.value.id ?? last;
        onEvent(JSON.parse(part.value.data) as T);
      }
      // Whether it ended or broke, the next answer tells: 204 to who has all events.
      if (!last) return;
    } catch (error) {
      const problem = asProblem(error);
      // No answer, or none now: the service is started again, or the line is down.
      if (problem.status !== 0 && problem.status < 500) throw problem;
    }
    await pause(PAUSE_MS, signal);
  }
}

export function pause(milliseconds: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, milliseconds);
    signal.addEventListener("abort", () => (clearTimeout(timer), resolve()), { once: true });
  });
}
