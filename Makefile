# Everything lives in .venv; `make help` lists the commands.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
READY := $(VENV)/.ready
CORE := $(wildcard tin/cpp/* tin/cpp/*/* terrain/cpp/* terrain/cpp/*/*)
TREE := build/typing
# A worker for each core takes tests from the others when it has none: a further one would spend
# more on collecting all tests than it saves.
PYTEST_WORKERS := -n $(shell getconf _NPROCESSORS_ONLN) --dist worksteal
# They write thousands of small files: in memory, where there is room, that takes less time.
SHARED := /dev/shm
ROOM = $(shell test -w $(SHARED) && df -Pm $(SHARED) | awk 'NR == 2 && $$4 >= 4000 { print "TMPDIR=$(SHARED)" }')
# Rewritten tests and compiled modules are kept: hundreds of tests start Python.
unexport PYTHONDONTWRITEBYTECODE

# Pins reach the isolated build of the core too.
export PIP_CONSTRAINT := $(CURDIR)/constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# Python compiles what is imported: compiling all of VTK beforehand would take longer than the demo.
export PIP_COMPILE := 0

.DEFAULT_GOAL := help
.PHONY: help setup demo test check bench proof fuzz format clean

help: ## List the commands
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-11s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(READY) ## Build the core and install everything into .venv

# What users have; the libraries arrive while the core compiles. The group dev holds all extras too:
# naming them here would build the core again.
LIBRARIES := $(VENV)/libraries.txt
$(INSTALLED): pyproject.toml constraints.txt CMakeLists.txt $(CORE)
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@$(BIN)/python -c "import tomllib; \
	  print(*tomllib.load(open('pyproject.toml', 'rb'))['project']['dependencies'], sep='\n')" > $(LIBRARIES)
	@$(BIN)/python -m pip install --quiet --requirement $(LIBRARIES) & libraries=$$!; \
	  $(BIN)/python -m pip install --quiet --no-deps --editable .; core=$$?; \
	  wait $$libraries && exit $$core
	@touch $(INSTALLED)

$(READY): $(INSTALLED)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet --group dev
	@touch $(READY)

demo: $(INSTALLED) ## Build both samples into demo/: TINs, pictures, contours, a profile, volumes
	@PATH="$(CURDIR)/$(BIN):$$PATH" sh sample_data/demo.sh demo

test: $(READY) ## Run the tests
	$(ROOM) $(BIN)/python -m pytest -q $(PYTEST_WORKERS)

check: $(READY) $(TREE) ## Lint, formatting, types, import contract
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	cd $(TREE) && ../../$(BIN)/mypy --config-file ../../pyproject.toml
	cd qgis && ../$(BIN)/mypy --config-file ../pyproject.toml --allow-subclassing-any
	cd blender && ../$(BIN)/mypy --config-file ../pyproject.toml --allow-subclassing-any
	cd $(TREE) && PYTHONPATH=. ../../$(BIN)/lint-imports --config ../../pyproject.toml

# The folders as the one package that they are once installed. Tools that look for modules on disk
# must see this instead of the root, where io/ would pass for Python's own io.
.PHONY: $(TREE)
$(TREE):
	@rm -rf $(TREE) && mkdir -p $(TREE)/tinsmith
	@cd $(TREE)/tinsmith && ln -s ../../../src/tinsmith/* . && ln -s ../../../tin ../../../io ../../../terrain .

bench: $(READY) ## Time kernel, lines, edits, queries, readers, writers beside their peers
	$(BIN)/python -m pip install --quiet --group bench
	$(BIN)/python -m benchmarks

.PHONY: docs
docs: $(READY) ## Build the site of the documentation into build/site; a warning is an error
	$(BIN)/sphinx-build -q -E -W --keep-going -c docs -d build/doctrees . build/site
	@echo "build/site/index.html"

.PHONY: gallery
gallery: $(READY) ## Draw the pictures of docs/gallery.md anew
	@set -e; for script in docs/gallery/*.py; do $(BIN)/python $$script; done

.PHONY: qgis-plugin
qgis-plugin: ## Pack the QGIS plugin as a zip into build/
	@$(PYTHON) packaging/pack_plug_in.py qgis

.PHONY: blender-addon
blender-addon: ## Pack the Blender add-on as a zip into build/
	@$(PYTHON) packaging/pack_plug_in.py blender

.PHONY: web
web: ## Build the page that triangulates a table in the browser into build/; needs Emscripten
	@$(PYTHON) web/make_page.py

.PHONY: page
page: ## Build the code of the 3D page anew from its sources; needs Node.js
	cd terrain/viewer/page && npm ci --silent && npm run --silent check && npm run --silent build
	@cd terrain/viewer/page && rm -rf node_modules
	PYTHONPATH=tests $(BIN)/python -m support.pages > terrain/viewer/page/viewer.sha256

.PHONY: slow
slow: $(READY) ## Run the tests of many seconds that `make test` leaves to CI
	$(ROOM) $(BIN)/python -m pytest -q $(PYTEST_WORKERS) -m slow

.PHONY: durations
durations: $(READY) ## Time all tests: those that take long are left to `make slow`
	$(ROOM) $(BIN)/python -m pytest -q $(PYTEST_WORKERS) -m "slow or not slow" --record-durations

# dist/ gets the same bytes for the same commit: times are those of the commit. The wheel is for this
# machine; those of all platforms are made by cibuildwheel.
BUILD_WHEEL := -m pip wheel --quiet --no-deps
DIST := SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) $(BIN)/python $(BUILD_WHEEL)
.PHONY: dist dist-source
dist-source: $(READY)
	@rm -rf dist && mkdir dist
	SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) $(BIN)/python -c "from scikit_build_core.build import build_sdist as b; b('dist')"
dist: dist-source ## Build the source distribution and a wheel of it into dist/
	$(DIST) --wheel-dir dist dist/*.tar.gz

.PHONY: dist-check
dist-check: dist ## Test what is in dist/: contents, installation without a compiler, small jobs
	TINSMITH_DIST=$(CURDIR)/dist $(BIN)/python -m pytest -q -m slow tests/packaging

# make wheels PYTHONS="python3.11 python3.12": that of 3.12 is abi3, for every later Python.
PYTHONS ?= $(BIN)/python
WHEELS := build/wheelhouse
.PHONY: wheels
wheels: dist-source ## Build wheels with their manylinux tags into build/wheelhouse: PYTHONS=
	$(BIN)/python -m pip install --quiet --group dist
	@rm -rf $(WHEELS) && mkdir -p $(WHEELS)/raw
	@set -e; for python in $(PYTHONS); do \
	  SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) $$python $(BUILD_WHEEL) --wheel-dir $(WHEELS)/raw dist/*.tar.gz; \
	done
	PATH="$(CURDIR)/$(BIN):$$PATH" auditwheel repair --wheel-dir $(WHEELS) $(WHEELS)/raw/*.whl

# Root, debootstrap and a network are needed; a machine with Python and no compiler is made of each suite.
SUITES ?= bookworm trixie
.PHONY: machines
machines: ## Try the wheels of build/wheelhouse, and the Dockerfile, on clean Debian machines: SUITES=
	@set -e; for suite in $(SUITES); do $(PYTHON) packaging/try_wheel.py $(WHEELS) $$suite; done
	$(PYTHON) packaging/run_dockerfile.py

proof: $(READY) ## Run the long proofs
	$(BIN)/python -m pytest -q -m proof

# make fuzz CASES=100000 CAMPAIGN="edits lines" SEED=7, or MINUTES=60; finds are kept in build/fuzz.
SEED ?= 1
FUZZ := PYTHONPATH=tests $(BIN)/python -m fuzz
fuzz: $(READY) ## Run random campaigns: MINUTES= or CASES=, SEED=, CAMPAIGN=
	$(FUZZ) --seed $(SEED) $(addprefix --campaign ,$(CAMPAIGN)) $(if $(CASES),--cases $(CASES)) $(addprefix --minutes ,$(MINUTES))

# The tests of tin and a slice of the campaigns about it with ASan and UBSan, those of threads with
# TSan. SANITIZE_CASES= makes the slice longer. Python alone captures: reports go past it.
SANITIZE_CASES ?= 200
SANITIZE_CAMPAIGNS ?= points lines edits refine voronoi contours volumes sections interpolation rasters \
  blunders screens screened ground sight simplify hydrology
SANITIZE_PRODUCTS := $(addprefix tests/terrain/,isolines earthwork gridding relief sections inspection \
  ground_filter sight hydrology test_simplification.py test_raster_simplification.py)
SANITIZE := tests/sanitizers/run.sh $(BIN)/python
SANITIZE_PYTEST := -m pytest -q -p no:cacheprovider --capture=sys --timeout 1800
.PHONY: sanitize sanitize-address sanitize-thread
sanitize: sanitize-address sanitize-thread ## Run tests and campaigns under ASan, UBSan and TSan
sanitize-address: $(READY)
	$(BIN)/python -m pip install --quiet --group sanitize
	$(SANITIZE) address $(SANITIZE_PYTEST) -n auto tests/tin $(SANITIZE_PRODUCTS)
	$(SANITIZE) address -m fuzz --no-memory-limit --folder build/sanitize/fuzz --cases $(SANITIZE_CASES) --seed $(SEED) $(addprefix --campaign ,$(SANITIZE_CAMPAIGNS))
sanitize-thread: $(READY)
	$(BIN)/python -m pip install --quiet --group sanitize
	$(SANITIZE) thread $(SANITIZE_PYTEST) tests/tin/test_threads.py tests/tin/editing/test_concurrency.py tests/terrain/earthwork/test_volumes.py tests/terrain/gridding/test_rasters.py

# make mutants MUTANTS=60 SEED=3 KIND=core; survivors are listed in build/mutants, too.
MUTANTS ?= 150
KIND ?= python core
.PHONY: mutants
mutants: $(READY) ## Change the code at random and list what the tests miss: MUTANTS=, KIND=
	$(BIN)/python -m pip install --quiet --group sanitize
	@test -d build/mutants/map || PYTHONPATH=tests $(BIN)/python -m mutation map
	@set -e; for kind in $(KIND); do \
	  PATH="$(CURDIR)/$(BIN):$$PATH" PYTHONPATH=tests $(BIN)/python -m mutation $$kind --count $(MUTANTS) --seed $(SEED); \
	done

format: $(READY) ## Format the code
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	$(BIN)/clang-format -i $$(git ls-files "t*/cpp/*.hpp" "t*/cpp/*.inc" "t*/cpp/*.cpp" "web/*.cpp" "tests/cpp/*.cpp" "benchmarks/compiled/*.cpp" "benchmarks/compiled/*.hpp")

clean: ## Remove what was built
	rm -rf $(VENV) build demo
