/** A picture that the service draws, fetched with the key. */
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../api/problem";
import { view } from "../api/views";
import { t } from "../text/text";

export function Picture({ path, label }: { path: string; label: string }) {
  const [source, setSource] = useState<string | null>(null);
  const [isMissing, setMissing] = useState(false);
  useEffect(() => {
    const asking = new AbortController();
    let url = "";
    view(path, asking.signal)
      .then((response) => response.blob())
      .then((blob) => setSource((url = URL.createObjectURL(blob))))
      .catch((error: unknown) => setMissing(asProblem(error).code !== "page_error"));
    return () => {
      asking.abort();
      if (url) URL.revokeObjectURL(url);
    };
  }, [path]);
  if (source) return <img class="picture" src={source} alt={label} />;
  return <p class="picture empty">{isMissing ? t("no_picture") : t("picture_is_made")}</p>;
}
