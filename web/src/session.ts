/** The key of the caller: kept by the browser until the tab is closed, and sent to this service alone. */

const NAME = "quadpatch-key";
const listeners = new Set<() => void>();

export function key(): string | null {
  return sessionStorage.getItem(NAME);
}

export function keepKey(text: string): void {
  sessionStorage.setItem(NAME, text);
  for (const listener of listeners) listener();
}

/** Without a key nothing changes: who hears of a change asks the service again. */
export function forgetKey(): void {
  if (key() === null) return;
  sessionStorage.removeItem(NAME);
  for (const listener of listeners) listener();
}

/** The header that carries the key, if there is one. */
export function keyHeader(): Record<string, string> {
  const text = key();
  return text === null ? {} : { "X-API-Key": text };
}

export function onKeyChange(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}
