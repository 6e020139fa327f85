/** Sentences of the page in the language of the reader. */
import { de } from "./de";
import { deService } from "./de_service";
import { en } from "./en";

export type TextKey = keyof typeof en;
export type Language = "en" | "de";

const MESSAGES: Record<Language, Record<TextKey, string>> = { en, de };
const NAME = "quadpatch-language";
const listeners = new Set<() => void>();

let current: Language = startLanguage();

export function language(): Language {
  return current;
}

export function setLanguage(chosen: Language): void {
  current = chosen;
  localStorage.setItem(NAME, chosen);
  document.documentElement.lang = chosen;
  for (const listener of listeners) listener();
}

export function onLanguageChange(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Values in a sentence, by their names there. */
export type Values = Record<string, string | number>;

/** A sentence; `{name}` in it stands for what `values` has under that name. */
export function t(key: TextKey, values: Values = {}): string {
  return filledIn(MESSAGES[current][key], values);
}

/** What the service says in English under a code, in the reader's language; null where it has to be shown as it is. */
export function tService(group: "warning" | "failure" | "problem" | "field", code: string, values: Values = {}): string | null {
  const key = `${group}_${code}`;
  if (current === "en") return null;
  const sentence = hasText(key) ? MESSAGES[current][key] : deService[key];
  return sentence === undefined ? null : filledIn(sentence, values);
}

function filledIn(sentence: string, values: Values): string {
  return sentence.replace(/\{(\w+)\}/g, (_, name: string) => shown(values[name] ?? `{${name}}`));
}

function shown(value: string | number): string {
  if (typeof value === "string") return value;
  const digits = Number.isInteger(value) ? {} : { maximumSignificantDigits: 3 };
  return new Intl.NumberFormat(current, digits).format(value);
}

/** The sentence of a code of the service, such as a state or a problem; the code where there is none. */
export function tCode(group: string, code: string): string {
  const key = `${group}_${code.replaceAll(".", "_")}`;
  return key in en ? t(key as TextKey) : code.replaceAll("_", " ");
}

export function hasText(key: string): key is TextKey {
  return key in en;
}

function startLanguage(): Language {
  const chosen = localStorage.getItem(NAME) ?? navigator.language.slice(0, 2);
  const known: Language = chosen === "de" ? "de" : "en";
  document.documentElement.lang = known;
  return known;
}
