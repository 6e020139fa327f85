/** Fields, buttons and tables, each with its label. */
import type { ComponentChildren } from "preact";
import { useId } from "preact/hooks";
import { download } from "../api/client";
import { useAction } from "../hooks";
import { t } from "../text/text";
import { ProblemNote } from "./notes";

export function Field(props: {
  label: string;
  value: string;
  onInput: (value: string) => void;
  type?: "text" | "password" | "number" | "date";
  hint?: string;
  required?: boolean;
  autocomplete?: "off" | "current-password";
}) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{props.label}</label>
      <input
        id={id}
        // Preact has a type of its own for each kind of input; which it is stands not fixed here.
        type={(props.type ?? "text") as "text"}
        step="any"
        value={props.value}
        required={props.required ?? false}
        autocomplete={props.autocomplete ?? "off"}
        aria-describedby={props.hint ? `${id}-hint` : undefined}
        onInput={(event) => props.onInput(event.currentTarget.value)}
      />
      {props.hint && <small id={`${id}-hint`}>{props.hint}</small>}
    </div>
  );
}

export function Choice<T extends string>(props: {
  label: string;
  value: T;
  options: readonly (readonly [T, string])[];
  onChange: (value: T) => void;
  hint?: string;
}) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{props.label}</label>
      <select
        id={id}
        value={props.value}
        aria-describedby={props.hint ? `${id}-hint` : undefined}
        onChange={(event) => props.onChange(event.currentTarget.value as T)}
      >
        {props.options.map(([value, name]) => <option key={value} value={value}>{name}</option>)}
      </select>
      {props.hint && <small id={`${id}-hint`}>{props.hint}</small>}
    </div>
  );
}

export function Check(props: { label: string; checked: boolean; onChange: (checked: boolean) => void }) {
  return (
    <label class="check">
      <input type="checkbox" checked={props.checked} onChange={(event) => props.onChange(event.currentTarget.checked)} />
      {props.label}
    </label>
  );
}

/** A table that scrolls by itself where it is wider than the page. */
export function Table(props: { caption: string; heads: string[]; children: ComponentChildren }) {
  return (
    <div class="table" tabIndex={0} role="region" aria-label={props.caption}>
      <table>
        <caption class="hidden">{props.caption}</caption>
        <thead><tr>{props.heads.map((head) => <th key={head} scope="col">{head}</th>)}</tr></thead>
        <tbody>{props.children}</tbody>
      </table>
    </div>
  );
}

/** A button that does something with the service, and says why it failed. */
export function ActionButton(props: { label: string; work: () => Promise<void>; class?: string; confirm?: string }) {
  const action = useAction();
  const start = () => {
    if (!props.confirm || confirm(props.confirm)) void action.run(props.work);
  };
  return (
    <>
      <button type="button" class={props.class} disabled={action.isBusy} onClick={start}>{props.label}</button>
      <ProblemNote problem={action.problem} />
    </>
  );
}

export function DownloadButton({ path, label }: { path: string; label: string }) {
  return <ActionButton label={label} work={() => download(path)} />;
}

export function Pager({ next, onNext, onFirst }: { next: string | null | undefined; onNext: (c: string) => void; onFirst?: (() => void) | undefined }) {
  if (!next && !onFirst) return null;
  return (
    <p class="actions">
      {onFirst && <button type="button" onClick={onFirst}>{t("first_page")}</button>}
      {next && <button type="button" onClick={() => onNext(next)}>{t("next_page")}</button>}
    </p>
  );
}

/** Facts as a list of names and values. */
export function Facts({ facts }: { facts: [string, ComponentChildren][] }) {
  return (
    <dl class="facts">
      {facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}
    </dl>
  );
}
