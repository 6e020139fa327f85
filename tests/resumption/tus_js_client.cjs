// node tus_js_client.cjs ENDPOINT FILE CHUNK_BYTES PARALLEL: send a file, print the URL of the upload.
const fs = require("fs");
const path = require("path");
const tus = require("tus-js-client");

const [endpoint, file, chunkBytes, parallel] = process.argv.slice(2);
const options = {
  endpoint,
  chunkSize: Number(chunkBytes) || Infinity,
  parallelUploads: Number(parallel),
  retryDelays: Array(2000).fill(200),
  metadata: { filename: path.basename(file) },
  onError(error) {
    console.error(String(error));
    process.exit(1);
  },
  onSuccess() {
    console.log(upload.url);
    process.exit(0);
  },
};
const upload = new tus.Upload(fs.createReadStream(file), options);
upload.start();
