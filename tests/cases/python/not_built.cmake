message(FATAL_ERROR "the package for Python is not built: install pybind11-dev, python3-dev and python3-numpy, or run tests/run")
