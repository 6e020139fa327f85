/** Keys of the service: made, replaced and revoked by who has the scope `admin`. */
import { useState } from "preact/hooks";
import { post, send } from "../api/client";
import type { Key, KeyList, KeyWithSecret, NewKey, Scope } from "../api/types";
import { useAction, useAnswer, useTitle } from "../hooks";
import { ActionButton, Check, Field, Table } from "../parts/forms";
import { Loading, Note, ProblemNote } from "../parts/notes";
import { keepKey, key } from "../session";
import { time } from "../text/format";
import { t, tCode } from "../text/text";

const SCOPES: readonly Scope[] = ["read", "upload", "repair", "models", "admin"];
const USUAL_SCOPES: Scope[] = ["read", "upload", "repair"];

export function KeysPage() {
  const keys = useAnswer<KeyList>("/v1/keys");
  const [made, setMade] = useState<KeyWithSecret | null>(null);
  const [madeFirst, setMadeFirst] = useState(false);
  useTitle(t("section_keys"));
  // Keys of the settings are not listed: who signed in has one of them.
  const isFirst = keys.value?.items.length === 0 && key() === null;
  const show = (made: KeyWithSecret | null) => {
    setMade(made);
    setMadeFirst(isFirst && made !== null);
    // The service asks for a key from now on, this page too.
    if (isFirst && made !== null) keepKey(made.key);
    keys.reload();
  };
  return (
    <>
      <h1>{t("section_keys")}</h1>
      <p>{t("keys_why")}</p>
      <ProblemNote problem={keys.problem} />
      {keys.value === null && !keys.problem && <Loading />}
      {made && (
        <Note>
          <p role="status">{t("key_made", { name: made.name })}</p>
          <p><code>{made.key}</code></p>
          {madeFirst && <p>{t("first_key_made")}</p>}
        </Note>
      )}
      {keys.value && (
        <Table
          caption={t("section_keys")}
          heads={[t("name"), t("tenant"), t("scopes"), t("created_at"), t("used_at"), t("expires_at"), t("change")]}
        >
          {keys.value.items.map((key) => <KeyRow key={key.id} of={key} onChange={show} />)}
        </Table>
      )}
      {keys.value && <NewKeyForm key={String(isFirst)} isFirst={isFirst} onMade={show} />}
    </>
  );
}

function KeyRow({ of: key, onChange }: { of: Key; onChange: (key: KeyWithSecret | null) => void }) {
  const revoke = async () => {
    await send("DELETE", `/v1/keys/${key.id}`);
    onChange(null);
  };
  return (
    <tr>
      <td>{key.name}</td>
      <td>{key.tenant}</td>
      <td>{key.scopes.map((scope) => tCode("scope", scope)).join(", ")}</td>
      <td>{time(key.created_at)}</td>
      <td>{time(key.used_at)}</td>
      <td>{key.revoked_at ? t("revoked") : time(key.expires_at)}</td>
      <td>
        {!key.revoked_at && (
          <div class="actions">
            <ActionButton
              label={t("rotate")}
              work={async () => onChange(await post<KeyWithSecret>(`/v1/keys/${key.id}/rotate`))}
              confirm={t("rotate_sure", { name: key.name })}
            />
            <ActionButton label={t("revoke")} work={revoke} confirm={t("revoke_sure", { name: key.name })} />
          </div>
        )}
      </td>
    </tr>
  );
}

function NewKeyForm({ isFirst, onMade }: { isFirst: boolean; onMade: (key: KeyWithSecret) => void }) {
  const [name, setName] = useState("");
  const [tenant, setTenant] = useState("");
  const [end, setEnd] = useState("");
  const [scopes, setScopes] = useState<Scope[]>(isFirst ? [...USUAL_SCOPES, "admin"] : USUAL_SCOPES);
  const action = useAction();
  const make = async () => {
    const key: NewKey = { name, scopes };
    if (tenant) key.tenant = tenant;
    if (end) key.expires_at = new Date(end).toISOString();
    onMade(await post<KeyWithSecret>("/v1/keys", key));
  };
  const toggle = (scope: Scope, has: boolean) =>
    setScopes(SCOPES.filter((one) => (one === scope ? has : scopes.includes(one))));
  return (
    <form class="card" onSubmit={(event) => (event.preventDefault(), void action.run(make))}>
      <h2>{t("new_key")}</h2>
      <p>{t("new_key_why")} {isFirst && t("first_key_why")}</p>
      <Field label={t("name")} value={name} onInput={setName} required />
      <Field label={t("tenant")} hint={t("tenant_hint")} value={tenant} onInput={setTenant} />
      <Field label={t("expires_at")} type="date" value={end} onInput={setEnd} />
      <fieldset class="choices">
        <legend>{t("scopes")}</legend>
        {SCOPES.map((scope) => (
          <Check key={scope} label={tCode("scope", scope)} checked={scopes.includes(scope)} onChange={(has) => toggle(scope, has)} />
        ))}
      </fieldset>
      <p class="actions"><button class="primary" disabled={action.isBusy}>{t("make_key")}</button></p>
      <ProblemNote problem={action.problem} />
    </form>
  );
}
