.DEFAULT_GOAL := help
.PHONY: help demo lint test docs bench clean

help: ## show this
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/'

demo: ## set up and build the IEA 15 MW blade into out/
	@./scripts/setup.sh
	.venv/bin/bladegen build iea15mw -o out/

lint: ## set up, lint and check types
	@./scripts/setup.sh test
	.venv/bin/ruff check
	.venv/bin/ruff format --check
	.venv/bin/mypy

test: lint ## the same, then run all tests
	.venv/bin/python -m pytest -n 2 --cov --cov-report=term --cov-fail-under=95

docs: ## set up and build the documentation into site/; warnings are errors
	@./scripts/setup.sh test
	NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet

bench: ## measure all benchmarks and write docs/measured.md
	@./scripts/setup.sh test
	.venv/bin/python benchmarks/table.py

clean: ## remove what was made here
	rm -rf .venv out site build dist .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
