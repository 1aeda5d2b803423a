"""Python's generated layer as `_c`, for the tests. Without numpy, its dtypes are the dicts that they are made from."""

import os
import sys
import types

try:
    import numpy  # noqa: F401
except ImportError:
    sys.modules["numpy"] = types.ModuleType("numpy")
    sys.modules["numpy"].dtype = dict
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python", "src", "voxtet"))
import _c  # noqa: E402, F401
