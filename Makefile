# Two commands for a newcomer: `make demo` and `make test`. Both set everything up first.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
READY  := $(VENV)/.ready
# Twice quiet: errors only.
PIP    := $(BIN)/python -m pip --quiet --quiet --disable-pip-version-check

.PHONY: demo web test contract-changes coverage test-slow test-postgres test-lowest explore faults resumption fuzz mutants flood contract check serve openapi samples lock sbom bench bench-stages bench-quality bench-scans clean

$(READY): pyproject.toml client/pyproject.toml constraints.txt
	@echo "setting up $(VENV); this takes a few minutes the first time ..." >&2
	@$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'Python 3.11 or newer is needed; set PYTHON=...')"
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) install --upgrade pip
	@$(PIP) install --constraint constraints.txt --editable ./client --editable '.[service,dev]'
	@touch $@

# What tests/contract needs besides: linters of OpenAPI and a generator of clients. Node.js itself comes as a wheel.
NODE       := tests/contract/node
NODE_READY := $(NODE)/node_modules/.ready
$(NODE_READY): $(NODE)/package-lock.json | $(READY)
	@PATH="$(abspath $(BIN)):$$PATH" npm ci --prefix $(NODE) --silent --no-audit --no-fund --ignore-scripts
	@touch $@

# The page. Its libraries are bundled; of Node.js nothing is installed with the service.
WEB_READY := web/node_modules/.ready
$(WEB_READY): web/package-lock.json | $(READY)
	@PATH="$(abspath $(BIN)):$$PATH" npm ci --prefix web --silent --no-audit --no-fund --ignore-scripts
	@touch $@

web: $(WEB_READY)         ## check the types of the page, and build it anew into service/page
	@PATH="$(abspath $(BIN)):$$PATH" npm --prefix web --silent run check
	@PATH="$(abspath $(BIN)):$$PATH" npm --prefix web --silent run build

demo: $(READY)            ## repair a raw scan and a relief over HTTP; results land in demo/
	@$(BIN)/python -m onebox demo

serve: $(READY)           ## a local stack on http://127.0.0.1:8000 until Ctrl-C
	@$(BIN)/python -m onebox serve

# One thread for each of the two processes: where four share two cores, each waits for the others. At most 8 minutes on
# two idle cores is the aim, 15 what it takes: what is slow is listed, so that it is made cheaper or gets a target of its
# own, such as `faults`.
# The tests start some hundred interpreters: with PYTHONDONTWRITEBYTECODE each would compile all modules again.
PYTEST := pytest -n 2 --dist loadfile
PYTHON_OF_TESTS := PYTHONDONTWRITEBYTECODE= OMP_NUM_THREADS=1 $(BIN)/python -m
TEST := $(PYTHON_OF_TESTS) $(PYTEST)
test: $(READY) $(NODE_READY) $(WEB_READY)  ## the tests, with the real Valkey
	@$(TEST) --durations 10 -m "not slow" $(ARGS)

# What it measures, and how child processes take part, stands in pyproject.toml under [tool.coverage.run].
coverage: $(READY)        ## lines and branches that `make test` runs: make coverage ARGS="tests/quadpatch/mesh"
	@rm -rf build/coverage && mkdir -p build/coverage
	@$(PYTHON_OF_TESTS) coverage run -m $(PYTEST) -m "not slow" $(ARGS); status=$$?; \
		$(BIN)/python -m coverage combine --quiet && $(BIN)/python -m coverage report && exit $$status

test-slow: $(READY)       ## the tests that take long: whole campaigns, trainings, local stacks that are killed
	@$(TEST) --durations 10 -m slow $(ARGS)

test-postgres: $(READY)   ## the tests of service and workers on PostgreSQL and S3, both started by the tests
	@TEST_BACKEND=postgres-s3 $(TEST) \
		tests/jobkit tests/service tests/worker tests/dispatcher tests/integration tests/contract tests/onebox

# In an environment of its own. Old versions warn of what they did not know yet, so warnings are no errors here. Locks,
# the bill of materials and openapi.yaml are written with the pinned versions.
LOWEST := .venv-lowest
test-lowest:              ## the tests with the lowest versions that pyproject.toml allows
	@$(PYTHON) -m venv $(LOWEST)
	@$(PYTHON) -m deploy.lowest > $(LOWEST)/lowest.txt
	@$(LOWEST)/bin/python -m pip --quiet install --constraint $(LOWEST)/lowest.txt \
		--editable ./client --editable '.[service,dev]'
	@touch $(LOWEST)/.ready
	@$(MAKE) --no-print-directory test VENV=$(LOWEST) ARGS="-W default --ignore tests/deploy \
		--deselect tests/service/contract/test_document.py::test_openapi_yaml_is_what_the_app_says $(ARGS)"

explore: $(READY)         ## the property tests with other examples than `make test` has: make explore ARGS="tests/quadpatch"
	@TEST_EXAMPLES=explore $(TEST) -m hypothesis $(ARGS)

resumption: $(READY)      ## large uploads while the server is killed: make resumption ARGS="--node-modules PATH --store s3"
	@$(BIN)/python -m tests.resumption $(ARGS)

# Network namespaces and disks that fill up need root; without it the suite says what it left out.
faults: $(READY)          ## kill, cut off and starve a cluster of real processes: make faults ARGS="--seed 7 --backend sqlite-local"
	@$(BIN)/python -m tests.faults $(ARGS)

fuzz: $(READY)            ## repair damaged meshes and judge what comes out: make fuzz ARGS="--count 300 --seed 1 --keep folder"
	@OMP_NUM_THREADS=1 $(BIN)/python -m tests.fuzz $(ARGS)

mutants: $(READY)         ## mutated files of all formats through a real local stack: make mutants ARGS="--count 500 --seed 1"
	@OMP_NUM_THREADS=1 $(BIN)/python -m tests.mutants $(ARGS)

contract: $(READY)        ## schemathesis, thousands of requests against a local stack: make contract ARGS="--examples 60 --seed 1"
	@OMP_NUM_THREADS=1 $(BIN)/python -m tests.contract $(ARGS)

contract-changes: $(READY) $(NODE_READY)  ## what breaks clients since a revision: make contract-changes BASE=v0.2.0
	@$(BIN)/python -m tests.contract.changes $(BASE)

check: $(READY)           ## ruff, import rules, types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/mypy

openapi: $(READY)         ## write openapi.yaml from the app
	@$(BIN)/python -m service openapi > openapi.yaml

samples: $(READY)         ## write the samples of README.md and docs/api.md from the answers of a real local stack
	@$(BIN)/python -m benchmarks.samples

# Needs the package index. Where pip also looks elsewhere, PIP_FIND_LINKS= and PIP_CONFIG_FILE=/dev/null leave that out.
lock: $(READY)            ## write the locks of the image, versions with hashes, from constraints.txt
	@$(BIN)/python -m deploy.lock

sbom: $(READY)            ## write what the image holds as CycloneDX: make sbom EXTRAS="service telemetry"
	@$(BIN)/python -m deploy.sbom $(EXTRAS) > sbom.cdx.json
	@echo "wrote sbom.cdx.json" >&2

bench: $(READY)           ## seconds and memory beside the peers: make bench ARGS="--peer-python PATH --quick"
	@$(BIN)/python -m benchmarks.performance $(ARGS)

bench-stages: $(READY)    ## speed of the method's stages
	@$(BIN)/python -m benchmarks.stages

flood: $(READY)           ## /healthz while thousands of idle clients hold connections: make flood ARGS="--seconds 35"
	@$(BIN)/python -m benchmarks.flood $(ARGS)

bench-quality: $(READY)   ## repair quality beside the peers: make bench-quality BENCH=folder ARGS="--radius all"
	@$(BIN)/python -m benchmarks.quality $(BENCH) $(ARGS)

bench-scans: $(READY)     ## raw scans, judged hole by hole: make bench-scans SCANS=folder ARGS="--model smooth"
	@$(BIN)/python -m benchmarks.scans $(SCANS) $(ARGS)

clean:
	rm -rf $(VENV) demo var build dist *.egg-info client/build client/*.egg-info
