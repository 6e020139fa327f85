# One image for every role; the command decides: `python -m service` (the API, default), `python -m dispatcher` or
# `python -m worker`.
# 3.11 is the Python that the locks were made for. For a build that can be repeated name the image by digest:
# --build-arg PYTHON_IMAGE=python:3.11-slim-bookworm@sha256:..., see docs/operations/deploy.md.
ARG PYTHON_IMAGE=python:3.11-slim-bookworm

FROM ${PYTHON_IMAGE} AS build
ENV PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_CACHE_DIR=1 PIP_ROOT_USER_ACTION=ignore
RUN python -m venv /opt/quadpatch
WORKDIR /source
# "service networks" adds torch, with which workers can fit a network to the mesh itself; "service telemetry" adds traces.
ARG EXTRAS=service
# The libraries first: they change less often than the source, and their layer is the large one. Each file is checked
# against the hash in its lock, what builds the project as well, and nothing is installed that is in no lock.
COPY deploy/locks deploy/locks
RUN for extra in build ${EXTRAS}; do set -- "$@" --requirement "deploy/locks/$extra.txt"; done \
    && /opt/quadpatch/bin/python -m pip install --only-binary :all: --require-hashes --no-deps "$@"
COPY . .
RUN /opt/quadpatch/bin/python -m pip install --no-deps --no-build-isolation ./client . \
    && /opt/quadpatch/bin/python -m pip check \
    && /opt/quadpatch/bin/python -m pip uninstall --yes pip setuptools

FROM ${PYTHON_IMAGE}
LABEL org.opencontainers.image.title="Quadpatch" \
      org.opencontainers.image.description="Repairs holes in 3D scans over HTTP" \
      org.opencontainers.image.licenses="GPL-3.0-or-later"
# A fixed number, so that the owner of files in a volume is the same on every host.
RUN groupadd --gid 10001 quadpatch \
    && useradd --uid 10001 --gid quadpatch --no-create-home --home-dir /data --shell /usr/sbin/nologin quadpatch \
    && install --directory --owner quadpatch --group quadpatch --mode 0750 /data
COPY --from=build /opt/quadpatch /opt/quadpatch
COPY LICENSE /usr/share/doc/quadpatch/LICENSE
ENV PATH=/opt/quadpatch/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    QUADPATCH_DATA_DIR=/data
WORKDIR /data
VOLUME /data
USER quadpatch
EXPOSE 8000
# For the API; dispatcher and worker are asked another question, see docker-compose.yml.
HEALTHCHECK --interval=15s --timeout=5s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import os, urllib.request as u; u.urlopen(f\"http://127.0.0.1:{os.environ.get('QUADPATCH_PORT', 8000)}/readyz\", timeout=4)"]
CMD ["python", "-m", "service"]
