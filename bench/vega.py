"""Draws a Vega-Lite specification as SVG by node and the build's own copy of Vega-Lite."""
import json
import subprocess
import tempfile
from pathlib import Path

RENDER = """
import {readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
const [web, figure, image] = process.argv.slice(2);
const load = createRequire(`${web}/package.json`);
const {vega, vegaLite} = {vega: load('vega'), vegaLite: load('vega-lite')};
const {spec} = vegaLite.compile(JSON.parse(readFileSync(figure, 'utf8')));
writeFileSync(image, await new vega.View(vega.parse(spec), {renderer: 'none'}).toSVG());
"""


def draw(web, figure, image):
    """web: the folder of the build's Vega-Lite, framework/report/web."""
    with tempfile.TemporaryDirectory() as folder:
        script, specification = Path(folder, "render.mjs"), Path(folder, "figure.json")
        script.write_text(RENDER)
        specification.write_text(json.dumps(figure))
        subprocess.run(["node", script, Path(web).resolve(), specification, image], check=True)
