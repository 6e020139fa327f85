/** Where scans are dropped, and those that are there. */
import { useState } from "preact/hooks";
import { withQuery } from "../api/client";
import type { MeshPage } from "../api/types";
import { useAnswer, useTitle } from "../hooks";
import { DropZone } from "../parts/dropzone";
import { Field, Pager, Table } from "../parts/forms";
import { Loading, ProblemNote } from "../parts/notes";
import { go } from "../route";
import { bytes, count, time } from "../text/format";
import { t, tCode } from "../text/text";

export function ScansPage() {
  const [filename, setFilename] = useState("");
  const [cursor, setCursor] = useState<string | null>(null);
  const pattern = filename && !filename.includes("*") ? `*${filename}*` : filename;
  const meshes = useAnswer<MeshPage>(withQuery("/v1/meshes", { filename: pattern, cursor }));
  useTitle(t("section_scans"));
  const onMesh = (mesh: string, nFiles: number) => (nFiles === 1 ? go(`/meshes/${mesh}`) : meshes.reload());
  return (
    <>
      <h1>{t("section_scans")}</h1>
      <DropZone label={t("drop_scans")} onMesh={onMesh} />
      <h2>{t("uploaded_scans")}</h2>
      <Field label={t("file_name")} value={filename} onInput={(text) => (setFilename(text), setCursor(null))} />
      <ProblemNote problem={meshes.problem} />
      {meshes.value === null && !meshes.problem && <Loading />}
      {meshes.value?.items.length === 0 && <p>{t("nothing_here")}</p>}
      {meshes.value && meshes.value.items.length > 0 && (
        <Table
          caption={t("uploaded_scans")}
          heads={[t("file_name"), t("state"), t("triangles"), t("holes"), t("size"), t("uploaded_at")]}
        >
          {meshes.value.items.map((mesh) => (
            <tr key={mesh.id}>
              <td><a href={`#/meshes/${mesh.id}`}>{mesh.filename ?? mesh.id.slice(0, 12)}</a></td>
              <td><State of={mesh.state} group="mesh_state" /></td>
              <td class="number">{mesh.triangles != null ? count(mesh.triangles) : "–"}</td>
              <td class="number">{mesh.holes != null ? count(mesh.holes) : "–"}</td>
              <td class="number">{bytes(mesh.size_bytes)}</td>
              <td>{time(mesh.created_at)}</td>
            </tr>
          ))}
        </Table>
      )}
      <Pager next={meshes.value?.next_cursor} onNext={setCursor} onFirst={cursor ? () => setCursor(null) : undefined} />
    </>
  );
}

/** A state in words, with a colour besides. */
export function State({ of, group }: { of: string; group: string }) {
  return <span class={`state ${of}`}>{tCode(group, of)}</span>;
}
