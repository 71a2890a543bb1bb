"""merge.py FOLDER CSV: the rows of all CSVs in FOLDER, which have one header, in CSV, and how each came to be in the JSON beside it."""
import json
import pathlib
import sys

folder, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
parts = sorted(folder.glob("*.csv"))
texts = [part.read_text().splitlines(keepends=True) for part in parts]
if not texts or any(text[0] != texts[0][0] for text in texts):
    sys.exit(f"merge.py: {folder}: no CSVs, or of different columns")
out.write_text("".join([texts[0][0]] + [line for text in texts for line in text[1:]]))
made = [json.loads(part.with_suffix(".json").read_text()) for part in parts]
out.with_suffix(".json").write_text(json.dumps({"results": out.name, "parts": made}, indent=2) + "\n")
