// A scan is uploaded, repaired and fetched by the client that openapi-typescript makes of openapi.yaml.
// node repair.ts URL SCAN REPAIRED
import { readFile, writeFile } from "node:fs/promises";
import { basename } from "node:path";
import createClient from "openapi-fetch";
import type { paths } from "./schema.d.ts";

const [url, scan, repaired] = process.argv.slice(2);
if (!url || !scan || !repaired) throw new Error("usage: repair.ts URL SCAN REPAIRED");
const client = createClient<paths>({ baseUrl: url });

function needed<T>(answer: { data?: T; error?: { code: string; detail: string } }): T {
  if (answer.data === undefined) throw new Error(`${answer.error?.code}: ${answer.error?.detail}`);
  return answer.data;
}

const bytes = await readFile(scan);
const mesh = needed(
  await client.POST("/v1/meshes", {
    params: { query: { filename: basename(scan) } },
    headers: { "Content-Type": "application/octet-stream" },
    body: bytes as unknown as string,
    bodySerializer: (body) => body,
  }),
);
const accepted = needed(
  await client.POST("/v1/jobs", {
    body: { mesh_id: mesh.id, method: { method: "smooth" }, metadata: { language: "TypeScript" } },
  }),
);
if (!("state" in accepted)) throw new Error("a plan came back in place of a job");
let job = accepted;
while (["queued", "running"].includes(job.state)) {
  job = needed(
    await client.GET("/v1/jobs/{job_id}", { params: { path: { job_id: job.id }, header: { Prefer: "wait=5" } } }),
  );
}
const path = { job_id: job.id };
const report = needed(await client.GET("/v1/jobs/{job_id}/report", { params: { path } }));
const result = needed(await client.GET("/v1/jobs/{job_id}/result", { params: { path }, parseAs: "arrayBuffer" }));
await writeFile(repaired, Buffer.from(result as ArrayBuffer));
// A string would be a part of it, which only a request with a range gets.
const verdicts = typeof report !== "string" && report.task === "fill" ? report.holes.map((hole) => hole.verdict) : [];
const refused = await client.GET("/v1/meshes/{mesh_id}", { params: { path: { mesh_id: "0".repeat(64) } } });
console.log(
  JSON.stringify({
    state: job.state,
    holes: verdicts,
    code: refused.error?.code,
  }),
);
