/** Where a person gives the key. */
import { useState } from "preact/hooks";
import { asProblem, type Problem, problemOf } from "../api/problem";
import { useTitle } from "../hooks";
import { Field } from "../parts/forms";
import { ProblemNote } from "../parts/notes";
import { keepKey } from "../session";
import { t } from "../text/text";

export function LoginPage() {
  const [text, setText] = useState("");
  const [problem, setProblem] = useState<Problem | null>(null);
  useTitle(t("sign_in"));
  const submit = async (event: Event) => {
    event.preventDefault();
    try {
      const answer = await fetch("/v1/limits", { headers: { "X-API-Key": text.trim() }, cache: "no-store" });
      if (!answer.ok) throw await problemOf(answer);
      keepKey(text.trim());
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  return (
    <form class="narrow" onSubmit={(event) => void submit(event)}>
      <h1>{t("sign_in")}</h1>
      <p>{t("sign_in_why")}</p>
      <Field
        label={t("key")}
        type="password"
        autocomplete="current-password"
        hint={t("key_hint")}
        value={text}
        onInput={setText}
        required
      />
      <p class="actions"><button class="primary">{t("sign_in")}</button></p>
      <ProblemNote problem={problem} />
    </form>
  );
}
