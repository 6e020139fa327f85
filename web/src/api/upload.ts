/** Uploads by tus 1.0: what has arrived is kept when the line breaks or the page is closed, and the rest is sent. */
import * as tus from "tus-js-client";
import { keyHeader } from "../session";
import { pause } from "./events";
import { Problem, problemOfText } from "./problem";

const RETRIES_MS = [0, 1000, 3000, 5000, 10_000, 20_000, 30_000];
const UPLOADS = "/v1/uploads";

/** Send a file; return the id of the mesh that it became. Raises Problem. */
export async function upload(file: File, onShare: (share: number) => void, signal: AbortSignal): Promise<string> {
  let mesh: string | null = null;
  const url = await new Promise<string>((resolve, reject) => {
    const sending = new tus.Upload(file, {
      endpoint: UPLOADS,
      headers: keyHeader(),
      metadata: { filename: file.name },
      retryDelays: RETRIES_MS,
      removeFingerprintOnSuccess: true,
      onProgress: (sent, total) => onShare(total ? sent / total : 0),
      onAfterResponse: (_, response) => {
        mesh = response.getHeader("Quadpatch-Mesh") ?? mesh;
      },
      onSuccess: () => resolve(sending.url ?? ""),
      onError: (error) => reject(uploadProblem(error)),
    });
    signal.addEventListener("abort", () => void sending.abort().then(() => reject(signal.reason)), { once: true });
    void start(sending);
  });
  // A large file takes longer to put together than the service lets the last request wait.
  for (; mesh === null; await pause(1000, signal)) {
    const response = await fetch(url, {
      method: "HEAD",
      headers: { ...keyHeader(), "Tus-Resumable": "1.0.0" },
      signal,
    });
    if (!response.ok) throw new Problem("upload_failed", `HTTP ${response.status}`, response.status);
    mesh = response.headers.get("Quadpatch-Mesh");
  }
  return mesh.split("/").at(-1) ?? "";
}

async function start(sending: tus.Upload): Promise<void> {
  const [previous] = await sending.findPreviousUploads();
  if (previous) sending.resumeFromPreviousUpload(previous);
  sending.start();
}

function uploadProblem(error: Error | tus.DetailedError): Problem {
  const response = "originalResponse" in error ? error.originalResponse : null;
  if (response) return problemOfText(response.getBody(), response.getStatus());
  return new Problem("unreachable", error.message, 0);
}
