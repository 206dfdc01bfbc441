# gaik: two commands matter, `make demo` and `make test`. `make help` lists the rest.

PYTHON ?= python3
VENV ?= .venv
ARGS ?=
MINUTES ?= 20
WORKERS ?= 3

BIN := $(VENV)/bin
PACKAGES := src/gaik_core src/gaik_ros src/touch_sim
# Files of tests are dealt to workers; those that mostly wait come first, so that none is left over at the end.
TESTS := test/test_faults.py test src/gaik_ros src/touch_sim src/gaik_core
PYTEST := ROS_PYTHON_CHECK_FIELDS=1 $(BIN)/python -m pytest
DEALT := --numprocesses $(WORKERS) --dist loadfile --no-loadscope-reorder
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt
DESCRIBED := $(wildcard $(addsuffix /setup.py,$(PACKAGES)) $(addsuffix /setup.cfg,$(PACKAGES)))

.DEFAULT_GOAL := help
.PHONY: help demo view test unit lint nightly soak reproduce bench docs pictures clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

demo: $(VENV)/ready ## watch the twin follow a circle and a lemniscate; options by ARGS="--feed-forward"
	@$(BIN)/python -m touch_sim.demo $(ARGS)

test: lint unit ## ruff and mypy, then all tests; options of pytest by ARGS="-k solver"

unit: $(VENV)/ready-to-test
	@$(PYTEST) $(DEALT) $(TESTS) $(ARGS)

lint: $(VENV)/ready-to-test ## ruff and mypy alone
	@$(BIN)/ruff check --quiet . && $(BIN)/ruff format --quiet --check . && echo "ruff: clean"
	@$(BIN)/mypy

view: $(VENV)/ready ## the suite with a live page on 127.0.0.1: drag the arm, press circle
	@$(BIN)/python -m touch_sim.view $(ARGS)

nightly: $(VENV)/ready-to-test ## the long tests too: a minute of saturation, 100 000 examples of each fuzz test
	@GAIK_NIGHTLY=1 $(PYTEST) $(TESTS) $(ARGS)

soak: $(VENV)/ready ## run the suite for MINUTES=20 and report memory and periods over time
	@$(BIN)/python -m touch_sim.soak --minutes $(MINUTES) $(ARGS)

reproduce: $(VENV)/ready ## every experiment of the paper, into out/paper
	@$(BIN)/gaik reproduce $(ARGS)

bench: out/bench/ready ## the benchmark against other packages, into docs/benchmarks.md
	@out/bench/bin/python benchmark/run.py $(ARGS)
	@out/bench/bin/python benchmark/rules.py

# An environment of its own: some of the packages want an older numpy. One that cannot be installed is skipped.
out/bench/ready: benchmark/requirements.txt
	@echo "Making out/bench: a few minutes, 3 GB, once."
	@test -x out/bench/bin/python || $(PYTHON) -m venv out/bench
	@out/bench/bin/python -m pip install --quiet 'numpy<2' 'setuptools<80' wheel
	@grep -v '^#' benchmark/requirements.txt | while read -r peer; do \
	  out/bench/bin/python -m pip install --quiet "$$peer" 'numpy<2' || echo "bench: no $$peer here; it is left out"; done
	@out/bench/bin/python -m pip install --quiet --use-pep517 --no-build-isolation --editable src/gaik_core
	@touch $@

pictures: $(VENV)/ready ## the pictures and tables that the docs show, all but the benchmark's
	@$(BIN)/python -m touch_sim.pictures
	@$(BIN)/python docs/algebra_pictures.py
	@$(BIN)/gaik reproduce --docs docs

docs: $(VENV)/ready ## the documentation as a site, into out/site
	@$(INSTALL) --requirement requirements-docs.txt
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet && echo "out/site/index.html"

clean: ## remove what was built and written, .venv too
	rm -rf $(VENV) out build install log
	find src test -name __pycache__ -prune -exec rm -rf {} +

# The environment: made once, and again when what it is made from changes.

$(VENV)/ready: requirements.txt constraints.txt $(DESCRIBED)
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	  || { echo "make: $(PYTHON) is missing or older than 3.11; install it with: sudo apt install python3"; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null \
	  || { echo "make: python3's venv module is missing; install it with: sudo apt install python3-venv"; exit 1; }
	@echo "Making $(VENV) from requirements.txt: about a minute, 600 MB, once."
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@$(INSTALL) --requirement requirements.txt
	@$(INSTALL) --use-pep517 --no-build-isolation --no-deps $(addprefix --editable ,$(PACKAGES))
	@echo "Compiling the kernels: about 40 s, once."
	@$(BIN)/python -m gaik_core.kernels
	@touch $@

$(VENV)/ready-to-test: $(VENV)/ready requirements-test.txt
	@$(INSTALL) --requirement requirements-test.txt
	@touch $@
