.DEFAULT_GOAL := help
LOCK = --quiet --universal --python-version 3.11 --no-header --no-emit-index-url --no-annotate
# What reads, perturbs and writes blades without pictures, families and compiled loops: locks/core.txt
CORE = annotated-doc|cadquery-ocp|et-xmlfile|filelock|h5py|lxml|markdown-it-py|mdurl|networkx|numpy|openpyxl|pillow|pygments|pyyaml|rich|ruamel-yaml|scipy|shellingham|threadpoolctl|trimesh|typer
.PHONY: help demo lint test test-all docs bench mutants lock licences sbom audit release clean

help: ## show this
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/'

demo: ## set up and build the IEA 15 MW blade into out/
	@./scripts/setup.sh
	.venv/bin/bladegen build iea15mw -o out/

lint: ## set up, lint and check types
	@./scripts/setup.sh test
	.venv/bin/ruff check
	.venv/bin/ruff format --check
	.venv/bin/mypy

test: lint ## the same, then test every law (JOBS=3 processes; COVER=1 counts lines)
	./scripts/test.sh -m "not nightly"

test-all: lint ## the same with what explores: nightly, and before a release
	COVER=1 HYPOTHESIS_PROFILE=thorough ./scripts/test.sh

docs: ## set up and build the documentation into site/; warnings are errors
	@./scripts/setup.sh test
	NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet
	.venv/bin/python scripts/search.py site

bench: ## measure all benchmarks and write docs/measured.md
	@./scripts/setup.sh test
	.venv/bin/python benchmarks/table.py

mutants: ## mutate the mathematics and run its tests on each mutant
	@./scripts/setup.sh dev
	.venv/bin/mutmut run && .venv/bin/mutmut results

lock: ## pin what is used and what it is developed with, in locks/
	@./scripts/setup.sh dev
	.venv/bin/uv pip compile $(LOCK) -o locks/run.txt pyproject.toml
	.venv/bin/uv pip compile $(LOCK) --extra dev -o locks/dev.txt pyproject.toml
	grep -E '^($(CORE))==' locks/run.txt | sed 's/^cadquery-ocp==/cadquery-ocp-novtk==/' > locks/core.txt

licences: ## list the licences of all that bladegen needs to run, into docs/licences.md
	@./scripts/setup.sh dev
	./scripts/licences.sh > docs/licences.md

sbom: ## write a software bill of materials, CycloneDX, into dist/
	@./scripts/setup.sh dev
	mkdir -p dist
	.venv/bin/cyclonedx-py requirements locks/run.txt --pyproject pyproject.toml -o dist/bladegen.cdx.json

audit: ## look known vulnerabilities of all that is pinned up
	@./scripts/setup.sh dev
	.venv/bin/pip-audit -r locks/dev.txt --no-deps --disable-pip

release: test-all ## run all tests, build sdist and wheel into dist/, and try the wheel in a fresh environment
	@./scripts/setup.sh dev
	./scripts/release.sh

clean: ## remove what was made here
	rm -rf .venv out site build dist .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
