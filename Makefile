# Everything from nothing but Python 3.11 or newer, pip, venv and make.
#   make demo    set up, then run one challenge scenario
#   make test    set up, then run every check
#   make setup   only prepare .venv/
#   make lock    rewrite requirements.lock (needs uv)

PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready-$(shell cat requirements.lock pyproject.toml | cksum | cut -d' ' -f1)
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: demo test setup lock clean

demo: setup
	$(BIN)/crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 --planner dwa

test: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/pytest -n auto

setup: $(READY)

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) scripts/check_machine.py
	@echo "setting up .venv (about a minute)"
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	@$(PIP) install --require-hashes -r requirements.lock
	@$(PIP) install --no-deps --no-build-isolation -e .
	@rm -f .venv/ready-* && touch $@

lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
		--quiet --group dev pyproject.toml -o requirements.lock

clean:
	rm -rf crowdbot/__pycache__/kernels-* .venv runs .mypy_cache .pytest_cache .ruff_cache .hypothesis
