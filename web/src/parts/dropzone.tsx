/** Where scans are dropped or chosen, and how far their uploads are. */
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { asProblem, type Problem } from "../api/problem";
import { upload } from "../api/upload";
import { bytes } from "../text/format";
import { t } from "../text/text";
import { ProblemNote } from "./notes";

interface Sending {
  file: File;
  share: number;
  mesh: string | null;
  problem: Problem | null;
}

/** Call `onMesh` with the id of each mesh that has arrived whole, and how many files were chosen with it. */
export function DropZone(props: { label: string; onMesh: (mesh: string, nFiles: number) => void; isSmall?: boolean }) {
  const [sendings, setSendings] = useState<Sending[]>([]);
  const [isOver, setOver] = useState(false);
  const input = useRef<HTMLInputElement>(null);
  const leaving = useRef(new AbortController());
  const hint = useId();
  // What is under way when the page is left goes on when the file is chosen again.
  useEffect(() => () => leaving.current.abort(), []);

  const begin = async (files: File[]) => {
    const begun = files.map((file): Sending => ({ file, share: 0, mesh: null, problem: null }));
    setSendings(begun);
    const change = (file: File, facts: Partial<Sending>) =>
      setSendings((all) => all.map((one) => (one.file === file ? { ...one, ...facts } : one)));
    for (const file of files) {
      try {
        const mesh = await upload(file, (share) => change(file, { share }), leaving.current.signal);
        change(file, { share: 1, mesh });
        props.onMesh(mesh, files.length);
      } catch (error) {
        if (leaving.current.signal.aborted) return;
        change(file, { problem: asProblem(error) });
      }
    }
  };

  return (
    <div>
      <div
        class={`dropzone${isOver ? " over" : ""}${props.isSmall ? " small" : ""}`}
        onDragOver={(event) => (event.preventDefault(), setOver(true))}
        onDragLeave={() => setOver(false)}
        onDrop={(event) => {
          event.preventDefault();
          setOver(false);
          void begin([...(event.dataTransfer?.files ?? [])]);
        }}
      >
        <p>{props.label}</p>
        <button type="button" aria-describedby={hint} onClick={() => input.current?.click()}>{t("choose_files")}</button>
        <input
          ref={input}
          class="hidden"
          type="file"
          multiple={!props.isSmall}
          tabIndex={-1}
          aria-hidden="true"
          aria-label={t("choose_files")}
          onChange={(event) => void begin([...(event.currentTarget.files ?? [])])}
        />
        <small id={hint}>{t("formats_hint")}</small>
      </div>
      <ul class="uploads" aria-live="polite">
        {sendings.map((one) => <li key={one.file.name}><UploadState sending={one} /></li>)}
      </ul>
    </div>
  );
}

function UploadState({ sending }: { sending: Sending }) {
  const { file, share, mesh, problem } = sending;
  return (
    <>
      {mesh ? <a href={`#/meshes/${mesh}`}>{file.name}</a> : <span>{file.name}</span>} <small>{bytes(file.size)}</small>
      <progress value={share} max={1} aria-label={t("upload_of", { name: file.name })} />
      <ProblemNote problem={problem} />
    </>
  );
}
