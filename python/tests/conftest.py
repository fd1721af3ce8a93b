import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def bars():
    """The two bars with little output, as a dict: a mesh of 20 elements each."""
    import carom

    case = carom.Case(ROOT / "cases/two-bars/case.toml")
    for name in ("striker", "target"):
        case["mesh"]["generate"][name]["line"]["elements"] = 20
    del case["output"]
    return case


@pytest.fixture(scope="session")
def command():
    """The command line, of the same build."""
    folder = os.environ.get("CARGO_TARGET_DIR", ROOT / "target")
    path = Path(folder) / "release" / ("carom.exe" if sys.platform == "win32" else "carom")
    if not path.is_file():
        pytest.skip("the command is not built: cargo build --release")
    return path
