"""Checks of documents of the page: its messages by their JSON schema, and its metrics by promtool and the dashboard."""

import json
import os
import re
import shutil
import subprocess

try:
    import jsonschema
except ImportError:
    jsonschema = None

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCHEMA = os.path.join(TOP, "docs", "reference", "page.schema.json")
DASHBOARD = os.path.join(TOP, "packaging", "grafana", "mural-wall.json")
# Messages that the schema must refuse, so that a schema without rules is found.
INVALID = ({"topic": "outputs", "dropped": 0, "data": [{"output": "a", "node": 0}]}, {"topic": "other", "dropped": 0, "data": []},
           {"id": 1, "ok": True}, {"input": {"seq": 1, "kind": "move", "x": 2, "y": 0}}, {"welcome": {"role": "owner"}})


def message_errors(received, sent):
    """Returns what the schema finds in the messages that a viewer has received and sent."""
    if jsonschema is None:
        print("    no comparison with the schema: this Python has no module jsonschema")
        return []
    with open(SCHEMA, encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    side = lambda name: jsonschema.Draft7Validator({**schema, "oneOf": [{"$ref": "#/definitions/" + name}]})
    wrong = ["the schema permits %s" % message for message in INVALID if side("fromPage").is_valid(message) or side("fromBrowser").is_valid(message)]
    for name, messages in (("fromPage", received), ("fromBrowser", sent)):
        for message in messages:
            best = jsonschema.exceptions.best_match(side(name).iter_errors(message))
            if best is not None:
                wrong.append("%s: %s at %s" % (str(message)[:120], best.message[:200], list(best.absolute_path)))
    return wrong[:3]


def metrics_errors(text):
    """Returns the errors of promtool in metrics, and the metrics of the dashboard that they lack."""
    with open(DASHBOARD, encoding="utf-8") as file:
        panels = json.load(file)["panels"]
    named = {name for panel in panels for target in panel["targets"] for name in re.findall(r"mural_\w+", target["expr"])}
    there = set(re.findall(r"^# TYPE (\w+) ", text, re.MULTILINE))
    wrong = ["metrics of the dashboard that the page lacks: %s" % sorted(named - there)] if named - there else []
    promtool = shutil.which("promtool")
    if promtool is None:
        print("    no check by promtool: it is not installed (Debian package prometheus, which also starts a server)")
        return wrong
    for metrics, is_right in ((text, True), (text + "# TYPE twice counter\ntwice 1\ntwice 1\n", False)):
        done = subprocess.run([promtool, "check", "metrics"], input=metrics.encode(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
        if (done.returncode == 0) != is_right:
            wrong.append("promtool: status %d, %s" % (done.returncode, done.stdout.decode()[:300]))
    return wrong
