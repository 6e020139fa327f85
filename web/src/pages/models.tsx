/** Models with their versions, cards and pictures, and what aliases mean. */
import { useAnswer, useTitle } from "../hooks";
import type { ModelList, ModelVersion } from "../api/types";
import { DownloadButton, Facts, Table } from "../parts/forms";
import { EnglishText, Loading, ProblemNote } from "../parts/notes";
import { Picture } from "../parts/picture";
import { bytes, count, number, time } from "../text/format";
import { t, tCode } from "../text/text";

export function ModelsPage() {
  const models = useAnswer<ModelList>("/v1/models?limit=100");
  useTitle(t("section_models"));
  if (models.problem) return <ProblemNote problem={models.problem} />;
  if (!models.value) return <Loading />;
  return (
    <>
      <h1>{t("section_models")}</h1>
      <p>{t("models_why")}</p>
      {models.value.models.flatMap((model) =>
        model.versions.map((version) => <Version key={`${version.name}@${version.version}`} version={version} />),
      )}
      <h2>{t("aliases")}</h2>
      <p>{t("aliases_why")}</p>
      <Table caption={t("aliases")} heads={[t("alias"), t("model"), t("changed_at")]}>
        {models.value.aliases.map((alias) => (
          <tr key={alias.alias}>
            <td>{alias.alias}</td>
            <td>{alias.name}@{alias.version}</td>
            <td>{time(alias.updated_at)}</td>
          </tr>
        ))}
      </Table>
    </>
  );
}

function Version({ version }: { version: ModelVersion }) {
  const { card } = version;
  const path = `/v1/models/${encodeURIComponent(version.name)}/versions/${version.version}`;
  const facts: [string, string][] = [
    [t("kind"), tCode("model_kind", version.kind)],
    [t("state"), tCode("model_state", version.state ?? "ready")],
    [t("size"), bytes(version.size_bytes)],
    [t("created_at"), time(version.created_at)],
  ];
  if (card.n_atoms) facts.push([t("atoms"), count(card.n_atoms)]);
  if (card.patch_resolution) facts.push([t("patch"), `${card.patch_resolution} × ${card.patch_resolution}`]);
  if (card.licence) facts.push([t("licence"), card.licence]);
  const metrics = Object.entries(card.metrics ?? {}).map(([name, value]): [string, string] => [name, number(value)]);
  return (
    <section class="card">
      <h2>{version.name}@{version.version}</h2>
      {version.deprecated && <p class="note">{t("deprecated")} {version.deprecated.reason}</p>}
      {card.description && <EnglishText text={card.description} summary={t("card_wording")} />}
      <div class="beside">
        <Facts facts={facts} />
        <Picture path={`${path}/picture`} label={t(version.kind === "dictionary" ? "picture_atoms" : "picture_filters", { name: version.name })} />
      </div>
      {metrics.length > 0 && <details><summary>{t("metrics")}</summary><p>{t("metrics_why")}</p><Facts facts={metrics} /></details>}
      <p class="sha">sha256 <code>{version.sha256}</code></p>
      <DownloadButton path={`${path}/artifact`} label={t("download")} />
    </section>
  );
}
