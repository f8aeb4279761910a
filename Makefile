# Everything runs in .venv, which each target sets up by itself.
#   make paper     the whole paper: tables and figures into results/      make smoke    the same with small samples
#   make figures   redraw what is drawn                                   make report   results/report.html
#   make run CONFIG=mine.yaml    with your own surfaces, pairs, beams; figures and report take CONFIG=... as well
#   make test      format, lint, tests                                    make test-all the slow tests too (minutes)
#   make cluster   test on a SLURM of this machine                        make mutants  test the tests
#   make bench     time the stages                                        make jobs     time and memory of a run's jobs
#   ARGS=...       goes to snakemake, e.g. ARGS=-n

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
SNAKEMAKE := $(BIN)/snakemake
SMOKE := --configfile config.yaml workflow/smoke.yaml
MINE := $(if $(CONFIG),--configfile config.yaml $(CONFIG))

ifneq ($(CONFIG),$(wildcard $(CONFIG)))
$(error cannot read $(CONFIG))
endif

.PHONY: help paper smoke figures run report test test-all lint format cluster mutants bench jobs lock clean
.DELETE_ON_ERROR:

paper: $(VENV)/ready
	$(SNAKEMAKE) $(ARGS) $(MINE)

help:
	@sed -n 's/^#   //p' Makefile

smoke: $(VENV)/ready
	$(SNAKEMAKE) --directory results/smoke $(SMOKE) $(ARGS)

figures: $(VENV)/ready
	$(SNAKEMAKE) figures $(ARGS) $(MINE)

run: $(VENV)/ready
	@test -n "$(CONFIG)" || { echo "make run needs a file with your settings: make run CONFIG=mine.yaml"; exit 2; }
	$(SNAKEMAKE) $(ARGS) $(MINE)

report: $(VENV)/ready
	$(SNAKEMAKE) --report results/report.html $(ARGS) $(MINE)

test: lint
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest $(ARGS)

test-all: lint
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest -m "not cluster" $(ARGS)

lint: $(VENV)/ready
	$(BIN)/ruff format --check src tests workflow
	$(BIN)/ruff check src tests workflow
	$(BIN)/snakefmt --check Snakefile workflow/rules
	$(SNAKEMAKE) --lint

format: $(VENV)/ready
	$(BIN)/ruff format src tests workflow
	$(BIN)/ruff check --fix src tests workflow
	$(BIN)/snakefmt Snakefile workflow/rules

# A SLURM of this machine alone; skipped with a reason where its daemons are not installed.
cluster: $(VENV)/ready
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock "snakemake-executor-plugin-slurm>=2.8,<3"
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest -m cluster -rs tests/workflow/test_slurm.py $(ARGS)

# Breaks the physics in small ways, one at a time in a copy, and counts the ways that no test notices.
mutants: $(VENV)/ready
	$(BIN)/python tests/mutants.py $(ARGS)

bench: $(VENV)/ready
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python tests/benchmarks/stages.py

# From the logs of the last run.
jobs: $(VENV)/ready
	$(BIN)/python tests/benchmarks/jobs.py

lock:
	uv pip compile --universal --python-version 3.11 --no-emit-index-url --no-header --no-annotate --upgrade --extra dev pyproject.toml -o requirements.lock

# .snakemake stays with results/: without its record of settings and code Snakemake compares times only, and old results
# would pass for those of new settings.
clean:
	rm -rf $(VENV)

$(VENV)/ready: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "stiction needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1). Try: make PYTHON=python3.12"; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

requirements.lock:
	@echo "requirements.lock is missing: it pins the versions of all libraries. Restore it: git checkout requirements.lock"; exit 2
