# Everything from nothing but Python 3.11 or newer, pip, venv and make.
#   make demo    set up, then run one challenge scenario
#   make check   set up, then run what a change has to pass before each commit, in 90 seconds
#   make test    set up, then run every check, and three commands on each Python that is there
#   make setup   only prepare .venv/
#   make test-all  run every test, also the longest
#   make durations  measure which tests are slow, into tests/durations.tsv; make check leaves them out
#   make coverage  run all tests, then write docs/developers/coverage.md
#   make docs    the site of the documentation, in build/site; fails on a dead link
#   make pictures  draw the pictures of README and documents anew, with the figures beside them
#   make generate renew all pages, tables and pictures that are made from the code
#   make changelog show the entries since the last release, as they will be printed
#   make check-js  lint the JavaScript of the pages (needs node and npm)
#   make lock    rewrite requirements.lock and requirements-run.lock
#   make sbom    list what a release consists of (CycloneDX), in build/crowdbot.cdx.json

PYTHON ?= python3
# Tests start hundreds of processes: without byte code each would translate all our files again.
export PYTHONDONTWRITEBYTECODE :=
BIN := .venv/bin
# One more than cores: many tests wait for processes, which leaves a fifth of the machine idle.
WORKERS = $(shell $(PYTHON) -c "import os; print(1 + (os.cpu_count() or 1))")
READY := .venv/ready-$(shell cat requirements-pip.lock requirements.lock pyproject.toml | cksum | cut -d' ' -f1)
# With what crowdbot needs to run, a third of all that.
RUNS := .venv/runs-$(shell cat requirements-pip.lock requirements-run.lock pyproject.toml | cksum | cut -d' ' -f1)
LOCK := $(BIN)/uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --quiet
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# uv takes a third of the time of pip. Where it cannot, as with an index that is set up for pip
# alone, pip does it.
UV := $(BIN)/uv pip install --quiet --python $(BIN)/python
# pip would use one core for this, for half of the set-up; a third are tests of packages, and half
# of the rest is what few processes import, if any, which write it then. It fails where a package
# has templates, which are not Python. Ours too: where the environment forbids Python to write byte
# code, each process would translate all of it.
SELDOM := IPython|autobahn|casadi|coacd|dask|debugpy|distributed|docutils|duckdb|fontTools|gymnasium|jedi|mosek|mypyc?|onnxruntime|pandas|pip|playwright|prompt_toolkit|setuptools|snowballstemmer|sphinx|tornado|twisted
BYTE_CODE := $(BIN)/python -m compileall -qq -j 0 -x '/tests?/|/site-packages/($(SELDOM))/'

JS := scripts/js
JS_READY := $(JS)/node_modules/.package-lock.json

.PHONY: demo check test test-here pythons tests tests-as-they-go test-all durations lint types style kernels coverage docs generate pictures changelog check-js js-where-node-is setup lock sbom clean

demo: $(RUNS)
	$(BIN)/crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 --planner dwa

check: setup
	@$(MAKE) --no-print-directory -j2 --output-sync kernels types style
	$(BIN)/pytest -n auto --dist worksteal -q -m "not slow and not jupedsim"

test: test-here
	@$(MAKE) --no-print-directory pythons

# Everything but the commands on other versions of Python. Types are checked while kernels compile,
# which takes one core, and while tests wait. What is wrong with them is printed last, too.
test-here: setup
	@$(MAKE) --no-print-directory -j2 --output-sync kernels style js-where-node-is types tests \
		|| { $(BIN)/mypy --no-error-summary; false; }

# Nothing that a person watches is held back until its end.
tests: kernels style js-where-node-is
	@+$(MAKE) --no-print-directory --output-sync=none tests-as-they-go

tests-as-they-go:
	$(BIN)/pytest -n $(WORKERS) --dist worksteal

# Three commands on each Python that README names; a line says which are missing.
pythons: setup
	@scripts/demo_on_each_python.sh

# What numba compiles, before tests begin: or else each test process would compile it.
kernels: setup
	@out=$$(mktemp -d) && $(BIN)/crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 \
		--planner dwa --set robots.robot.task.time_limit=1 --out $$out > $$out/printed 2>&1 \
		|| { cat $$out/printed; exit 1; }; rm -rf $$out

lint: style types

types: setup
	$(BIN)/python scripts/check_types.py

style: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell
	$(BIN)/python scripts/check_vocabulary.py
	$(BIN)/lint-imports

# With the longest tests too, which tests/long_tests.py lists, and all examples of properties.
test-all: setup kernels
	CROWDBOT_ALL_TESTS=1 $(BIN)/pytest -n auto --dist worksteal

durations: setup kernels
	$(BIN)/pytest -p tests.processor_time -n auto --dist worksteal

coverage: setup
	$(BIN)/python scripts/write_coverage.py

docs: setup
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet -b html docs build/site
	@echo "build/site/index.html"

generate: setup
	$(BIN)/python scripts/generate.py

pictures: setup
	$(BIN)/python scripts/make_pictures.py

changelog: setup
	$(BIN)/towncrier build --draft --version next

check-js: $(JS_READY)
	node $(JS)/lint.mjs

js-where-node-is:
	@if command -v node >/dev/null && command -v npm >/dev/null && $(MAKE) --no-print-directory $(JS_READY); \
	then $(MAKE) --no-print-directory check-js; \
	else echo "the JavaScript of the pages is not linted: that needs node 20 and npm"; fi

$(JS_READY): $(JS)/package-lock.json
	npm ci --prefix $(JS) --silent
	@touch $@

setup: $(READY)

# A file $(1) says what is set up from the lock $(2).
define set_up
	@$(PYTHON) scripts/check_machine.py
	@echo "setting up .venv (about a minute)"
	@$(PIP) --version > /dev/null 2>&1 || $(PYTHON) -m venv --clear .venv  # none, or an interrupted one
	@$(PIP) install --no-compile --require-hashes -r requirements-pip.lock
	@$(UV) --require-hashes -r $(2) \
		|| { echo "uv could not; pip will"; $(PIP) install --no-compile --require-hashes -r $(2); }
	@$(PIP) install --no-compile --no-deps --no-build-isolation -e .
	@$(BYTE_CODE) .venv/lib crowdbot || true
	@rm -f .venv/ready-* .venv/runs-* && touch $(1)
endef

$(READY): requirements-pip.lock requirements.lock pyproject.toml
	$(call set_up,$(READY) $(RUNS),requirements.lock)

$(RUNS): requirements-pip.lock requirements-run.lock pyproject.toml
	$(call set_up,$(RUNS),requirements-run.lock)

# The second one has the same versions.
lock: setup
	$(LOCK) --group dev pyproject.toml -o requirements.lock
	$(LOCK) --group build pyproject.toml -c requirements.lock -o requirements-run.lock

sbom: setup
	$(BIN)/python scripts/write_sbom.py build/crowdbot.cdx.json

clean:
	rm -rf crowdbot/__pycache__/kernels* .venv runs .mypy_cache .pytest_cache .ruff_cache .hypothesis \
		.coverage $(JS)/node_modules
