/** How much work a repair may take, in plain words. */
import { t } from "../text/text";

export type Effort = "fast" | "standard" | "best";
const EFFORTS: readonly Effort[] = ["fast", "standard", "best"];

export function EffortChoice({ value, onChange }: { value: Effort; onChange: (effort: Effort) => void }) {
  return (
    <fieldset class="choices">
      <legend>{t("effort")}</legend>
      {EFFORTS.map((effort) => (
        <label key={effort} class="check">
          <input type="radio" name="effort" value={effort} checked={effort === value} onChange={() => onChange(effort)} />
          <span><strong>{t(`effort_${effort}`)}</strong> <small>{t(`effort_${effort}_why`)}</small></span>
        </label>
      ))}
    </fieldset>
  );
}
