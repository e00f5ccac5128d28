"""Brings the npm package into the wheel, with its wasm modules. They are built, not stored: without them there is no wheel."""

import json
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NPM = Path(__file__).resolve().parent.parent / "pkg"


class NpmPackage(BuildHookInterface):  # type: ignore[type-arg]
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        # An editable install finds pkg/ beside cluster/.
        if version == "editable":
            return
        for built in ("wasm", "element.min.js", "element-tiles.min.js"):
            if not (NPM / built).exists():
                raise SystemExit(f"{NPM / built} is not built: run `cargo xtask build` in {NPM.parent}, then install again")
        files = json.loads((NPM / "package.json").read_text())["files"]
        for path in sorted({path for pattern in [*files, "package.json"] for path in NPM.glob(pattern)}):
            build_data["force_include"][str(path)] = f"pointweave_dask/npm/{path.name}"
