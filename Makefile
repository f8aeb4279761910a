# Each target first creates the virtual environment .venv if necessary and runs in it. Results are in results/ below the
# folder of a run: the folder of this file, or runs/smoke, runs/example and runs/devices.
#   make paper      the whole paper: tables and figures in results/ (5 to 10 minutes)
#   make smoke      the same with small samples (half a minute), in runs/smoke/results/   (takes CONFIG=... too)
#   make run CONFIG=mine.yaml    your own surfaces, pairs and beams; the file changes single keys of config.yaml
#   make example    crack lengths from drawn scans, compared with the true values (1 to 2 minutes), in runs/example/
#   make example-process   the best etch time from drawn scans (3 to 5 minutes), in runs/example-process/
#   make example-beams   a device with and without drawn test beams, beside the truth, in runs/example-beams/
#   make measured-beams   what the beams that the paper measured say as test beams (4 minutes), in runs/measured-beams/
#   make devices    safe lengths, stoppers and their uncertainty: examples/devices.yaml, or CONFIG=... (3 to 6 minutes),
#                   in runs/devices/results/
#   make model-error    Table III under full elastic contact, after make paper (3 minutes on two cores; takes CONFIG=... too)
#   make sealed     devices in dry nitrogen, bare and coated (14 minutes on two cores), in runs/sealed/results/
#   make attraction     Table III with attraction across gaps (3 minutes on two cores), in runs/attraction/results/
#   make asperities     Table III with other readings of an asperity, after make paper (6 minutes on two cores)
#   make print      the paper under the reading nearest to its printed Table III, beside the base case, after make paper
#                   (14 minutes on two cores), in runs/print/ and runs/print-finer/
#   make supplement     baseline, sizes and shares beside the paper's statements, after make paper (1 minute), in
#                   runs/supplement/
#   make validation     every experiment of validation/ beside its prediction (8 minutes on two cores), in runs/validation/
#   make pressing       how much more a pair sticks after its surfaces were pressed (2 minutes on two cores)
#   make surrogate  learn the estimate at once from drawn surfaces (three hours of a core), in runs/surrogate/
#   make figures    redraw the figures                       (takes CONFIG=... too)
#   make report     results/report.html                      (takes CONFIG=... too)
#
#   make test       format, lint and tests                   make test-all   the slow tests as well
#   make test-slow  the slow tests alone; those that fail are run a second time
#   make nightly    continuous integration and the tests that CONTRIBUTING.md names
#   make format     format the code                          make mutants    break the code, name undetected errors
#   make bench      time the stages                          make times      time the commands (half an hour)
#   make peers      time the same work here and in public libraries
#   make docs       build the documentation                  make numbers    take its numbers and pictures from results/
#   make jobs       time and memory of the jobs of the last run
#   make cluster    test with SLURM on this machine          make lock       update requirements.lock
#   make clean      delete .venv, keep results
#
#   ARGS=...        further arguments for the tool that a target runs, which is Snakemake for the first group: ARGS=-n
#                   says what it would compute. These targets call the command .venv/bin/stiction, see stiction --help.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STICTION := $(BIN)/stiction
# The tests of a file share what they compute; the longest files come first, in the order of tests/conftest.py.
WORKERS := --numprocesses auto --maxprocesses 4 --dist loadfile --no-loadscope-reorder
EMPTY :=
SPACE := $(EMPTY) $(EMPTY)
SPECIAL := ' " & ; | < > ` * ? [ ] ( ) \ !

# Snakemake starts its jobs without quotes around the path of the interpreter.
ifneq (,$(findstring $(SPACE),$(CURDIR))$(strip $(foreach sign,$(SPECIAL),$(findstring $(sign),$(CURDIR)))))
$(error the path of this folder ($(CURDIR)) contains a space or one of $(SPECIAL), which Snakemake does not support: move or rename it)
endif
ifneq (,$(findstring $(SPACE),$(CONFIG)))
$(error the name of the file in CONFIG contains a space ($(CONFIG)): rename the file)
endif

.PHONY: help paper smoke example example-process example-beams measured-beams devices model-error asperities pressing surrogate drawn-devices print supplement validation sealed tails full-contact-times deformed attraction figures run report test test-all test-slow nightly lint libraries format slurm cluster mutants bench peers times jobs docs numbers lock clean
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help

help:
	@sed -n 's/^#   //p; s/^#$$//p' Makefile

paper: $(VENV)/ready
	$(STICTION) $(if $(CONFIG),run $(CONFIG),paper) -- $(ARGS)

smoke: $(VENV)/ready
	$(STICTION) run workflow/smoke.yaml $(CONFIG) --directory runs/smoke -- $(ARGS)

# Draws the scans, writes them as files of microscopes, and computes the tables and the sheets of the surfaces from the files.
example: $(VENV)/ready
	$(BIN)/python examples/scans/draw.py runs/example
	cp examples/scans/mine.yaml runs/example/
	$(STICTION) run runs/example/mine.yaml --directory runs/example -- measured $(ARGS)
	$(BIN)/python examples/scans/compare.py runs/example

# Draws scans after four etch times by a known law, and computes which etch time suffices for two stoppers.
example-process: $(VENV)/ready
	$(BIN)/python examples/process/draw.py runs/example-process
	cp examples/process/mine.yaml runs/example-process/
	$(STICTION) devices runs/example-process/mine.yaml --directory runs/example-process -- $(ARGS)

# Draws test beams and the true lengths of a device, and compares what the test beams say about the device.
example-beams: $(VENV)/ready
	$(BIN)/python examples/drawn_beams/draw.py runs/example-beams
	cp examples/drawn_beams/mine.yaml runs/example-beams/
	$(STICTION) devices runs/example-beams/mine.yaml --directory runs/example-beams -- $(ARGS)
	$(BIN)/python examples/drawn_beams/compare.py runs/example-beams

measured-beams: $(VENV)/ready
	$(BIN)/python examples/measured_beams.py runs/measured-beams

devices: $(VENV)/ready
	$(STICTION) devices $(CONFIG) --directory runs/devices -- $(ARGS)

model-error: $(VENV)/ready
	$(STICTION) run $(CONFIG) workflow/model_error.yaml -- model_error $(ARGS)

asperities pressing: $(VENV)/ready
	$(STICTION) $(if $(CONFIG),run $(CONFIG),paper) -- $@ $(ARGS)

# All tables and figures under other readings of the paper, then Table III of both.
print: $(VENV)/ready
	$(STICTION) run examples/print.yaml --directory runs/print -- tables figures $(ARGS)
	$(BIN)/python examples/compare_print.py . runs/print
	$(STICTION) run examples/print.yaml examples/print_finer.yaml --directory runs/print-finer -- \
	  results/tables/variants.csv $(ARGS)

supplement: $(VENV)/ready
	$(BIN)/python examples/supplement.py .

# One job for each experiment; continues where it was stopped.
validation: $(VENV)/ready
	$(BIN)/snakemake --snakefile examples/validation/Snakefile --directory runs/validation --cores all $(ARGS)

sealed: $(VENV)/ready
	$(STICTION) devices examples/sealed.yaml --directory runs/sealed -- $(ARGS)

# Cracks on force curves themselves, compared with those on Eq. (12): twenty minutes of one core.
tails: $(VENV)/ready
	$(BIN)/python tests/benchmarks/tails.py $(ARGS) | tee docs/tables/tails.md

# Attraction across the gaps of deformed surfaces, in full elastic contact: three minutes of one core.
deformed: $(VENV)/ready
	$(BIN)/python tests/benchmarks/deformed.py $(ARGS) | tee docs/tables/deformed.md

# Full elastic contact and its floor: two minutes of one core.
full-contact-times: $(VENV)/ready
	$(BIN)/python tests/benchmarks/full_contact.py | tee docs/tables/full_contact_times.md

attraction: $(VENV)/ready
	$(STICTION) run $(or $(CONFIG),examples/attraction.yaml) --directory runs/attraction -- results/tables/variants.csv $(ARGS)

# Table, page and errors of stiction estimate. All points are computed again only if the control numbers changed.
surrogate: $(VENV)/ready
	mkdir -p runs/surrogate
	$(BIN)/python -m stiction.estimate.learning.jobs.control runs/surrogate/control.json
	$(BIN)/snakemake --snakefile workflow/surrogate.smk --directory runs/surrogate $(ARGS)
	cp runs/surrogate/table.json src/stiction/estimate/table.json
	$(BIN)/python -m stiction.estimate.page docs/_static/estimate.html
	$(BIN)/python -m stiction.estimate.learning.held_out runs/surrogate docs/tables/safe_lengths.csv docs/tables/stoppers.csv \
	  examples/devices.yaml docs/tables/drawn_safe_lengths.csv docs/tables/drawn_stoppers.csv examples/drawn_devices.yaml \
	  > docs/tables/estimate.md

# Simulated limits of ten drawn devices, beside which the table of the estimate shows its own.
drawn-devices: $(VENV)/ready
	$(STICTION) run examples/drawn_devices.yaml --directory runs/drawn-devices -- results/tables/safe_lengths.csv \
	  results/tables/stoppers.csv $(ARGS)
	cp runs/drawn-devices/results/tables/safe_lengths.csv docs/tables/drawn_safe_lengths.csv
	cp runs/drawn-devices/results/tables/stoppers.csv docs/tables/drawn_stoppers.csv

figures: $(VENV)/ready
	$(STICTION) figures $(CONFIG) -- $(ARGS)

run: $(VENV)/ready
	@test -n "$(CONFIG)" || { echo "make run needs a file with your settings: make run CONFIG=mine.yaml"; exit 2; }
	$(STICTION) run $(CONFIG) -- $(ARGS)

report: $(VENV)/ready
	$(STICTION) report $(CONFIG) -- $(ARGS)

test: lint
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest $(WORKERS) $(ARGS)

test-all: lint
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest $(WORKERS) -m "not cluster" $(ARGS)

# Those that fail are run again, alone, and must then pass. With status 1 of pytest all were run, with any other some were not.
test-slow: SLOW := slow and not browser and not cluster and not nightly
test-slow: lint
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest $(WORKERS) -m "$(SLOW)" --durations 30 $(ARGS) || \
	  { [ $$? = 1 ] && $(BIN)/python -m pytest -m "$(SLOW)" --last-failed --last-failed-no-failures none; }

nightly:
	.ci/run nightly

lint: $(VENV)/ready
	$(BIN)/ruff format --check src tests workflow docs examples
	$(BIN)/ruff check src tests workflow docs examples
	$(BIN)/snakefmt --check Snakefile workflow examples

format: $(VENV)/ready
	$(BIN)/ruff format src tests workflow docs examples
	$(BIN)/ruff check --fix src tests workflow docs examples
	$(BIN)/snakefmt Snakefile workflow examples

# The plugin of Snakemake.
slurm: $(VENV)/ready
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock "snakemake-executor-plugin-slurm>=2.8,<3"

# A SLURM cluster on this machine; the test is skipped, with the reason, if the daemons of SLURM are not installed.
cluster: slurm
	$(BIN)/python -m stiction.run.warmup
	$(BIN)/python -m pytest -m "cluster and not nightly" -rs tests/workflow/test_slurm.py $(ARGS)

# Makes one small error at a time in a copy of the code, and names those that no test detects.
# ARGS: modules or folders such as devices.risk, --number 600, --seed 0, --list.
mutants: $(VENV)/ready
	$(BIN)/python tests/mutants.py $(ARGS)

bench: $(VENV)/ready
	$(BIN)/python -m stiction.run.warmup
	{ $(BIN)/python tests/benchmarks/stages.py; $(BIN)/python tests/benchmarks/scaling.py docs/pictures/scaling.png; } \
	  | tee docs/tables/bench.md

# Installs the libraries that it compares with.
peers: $(VENV)/ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock --no-build-isolation --editable ".[peers]"
	$(BIN)/python tests/benchmarks/peers.py | tee docs/tables/peers.md

# Runs every command of the README in folders of its own: half an hour, on a machine without other work.
times: $(VENV)/ready
	mkdir -p results
	$(BIN)/python tests/benchmarks/commands.py > results/timings.csv
	mv results/timings.csv docs/tables/timings.csv

# Reads the logs of the last run.
jobs: $(VENV)/ready
	$(BIN)/python tests/benchmarks/jobs.py

# Updates tracked files: numbers, tables and pictures of the docs, from finished runs.
numbers: $(VENV)/ready
	$(BIN)/python docs/update.py results

# Builds HTML, without network access, and changes no tracked file.
docs: $(VENV)/ready
	@test -f docs/_build/html/searchindex.js || rm -rf docs/_build  # left by a build that was stopped
	$(BIN)/python -m sphinx -W --keep-going -n -q docs docs/_build/html
	@echo "open docs/_build/html/index.html"

# Keeps pinned versions as long as pyproject.toml allows them; ARGS=--upgrade updates all. Requires uv.
lock:
	uv pip compile --universal --python-version 3.11 --no-emit-index-url --no-header --no-annotate \
	  --extra dev --extra docs --extra scans --extra workflow $(ARGS) pyproject.toml -o requirements.lock
	@{ echo '# Pinned dependencies for Python 3.11 to 3.14, from pyproject.toml by `make lock`.'; cat requirements.lock; } \
	  > requirements.lock.new && mv requirements.lock.new requirements.lock

# Keeps .snakemake with results/: without its record of the code, Snakemake would accept results of other code.
clean:
	rm -rf $(VENV)

define LIBRARIES
$(PYTHON) -m venv $(VENV)
$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
endef

# Without the package: continuous integration installs those of another Python beside the first.
libraries:
	$(LIBRARIES)

$(VENV)/ready: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "stiction needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1). Try: make PYTHON=python3.12"; exit 2; }
	@$(PYTHON) -c 'import shutil, sys; sys.exit(sys.version_info >= (3, 14) and not any(map(shutil.which, ("cc", "gcc", "clang"))))' || \
	  { echo "with Python 3.14 or newer a library of Snakemake (immutables) is compiled, which needs a C compiler (cc); $(PYTHON) is $$($(PYTHON) --version 2>&1). Install one, or try: make PYTHON=python3.13"; exit 2; }
	$(LIBRARIES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/python -m stiction.command.editor_schema
	$(BIN)/python -m stiction.run.warmup
	@touch $@

requirements.lock:
	@echo "requirements.lock is missing: it pins the versions of all libraries. Restore it: git checkout requirements.lock"; exit 2
