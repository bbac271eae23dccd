"""Experiment files, each with one mistake or one oddity: what users, editors and programs make of them."""
import random

import yaml

FLOAT, TEXT = "tag:yaml.org,2002:float", "tag:yaml.org,2002:str"
# The same edit at so many places of a file.
PLACES = 2


def plain(text):
    return yaml.compose(text)


def flow(text):
    node = yaml.compose(text)
    node.flow_style = True
    return node


REPLACEMENTS = {
    "list for value": lambda: flow("[1, 2]"),
    "map for value": lambda: flow("{a: 1}"),
    "text for value": lambda: plain("much"),
    "true for value": lambda: plain("true"),
    "null for value": lambda: plain("null"),
    "nan": lambda: plain(".nan"),
    "bare nan": lambda: plain("nan"),
    "infinity": lambda: plain("-.inf"),
    "negative": lambda: plain("-3"),
    "zero": lambda: plain("0"),
    "huge": lambda: plain("1e308"),
    "overflow": lambda: plain("1e999"),
    "huge count": lambda: plain("1000000000000000000"),
    "beyond 64 bits": lambda: plain("123456789012345678901234567890"),
    "tiny": lambda: plain("1e-320"),
    "octal": lambda: plain("007"),
    "long text": lambda: yaml.ScalarNode(TEXT, "x" * 100_000),
    "long number": lambda: yaml.ScalarNode("tag:yaml.org,2002:int", "1" + "0" * 100_000),
    "long expression": lambda: plain("1" + "+1" * 20_000),
    "deep expression": lambda: plain("(" * 20_000 + "1" + ")" * 20_000),
    "control characters": lambda: yaml.ScalarNode(TEXT, "a\x07\x1b[31mb", style='"'),
    "empty text": lambda: yaml.ScalarNode(TEXT, "", style='"'),
    "quoted number": lambda: yaml.ScalarNode(TEXT, "1", style='"'),
    "division by zero": lambda: plain("1/0"),
    "empty list": lambda: flow("[]"),
    "empty map": lambda: flow("{}"),
}


def list_values(node, path=()):
    """(path, parent, index) of everything below the node; the index is that of an item or of an entry."""
    children = []
    if isinstance(node, yaml.MappingNode):
        children = [((*path, key.value), node, i, value) for i, (key, value) in enumerate(node.value)]
    elif isinstance(node, yaml.SequenceNode):
        children = [((*path, i), node, i, item) for i, item in enumerate(node.value)]
    for below, parent, index, child in children:
        yield below, parent, index
        yield from list_values(child, below)


def replace(parent, index, node):
    if isinstance(parent, yaml.MappingNode):
        parent.value[index] = (parent.value[index][0], node)
    else:
        parent.value[index] = node


def remove(parent, index):
    del parent.value[index]


def rename(parent, index):
    key, value = parent.value[index]
    parent.value[index] = (yaml.ScalarNode(TEXT, key.value[:-1] + key.value[-1] * 2), value)


def duplicate(parent, index):
    parent.value.append(parent.value[index])


def choose(places, count, key):
    return random.Random(key).sample(places, min(count, len(places)))


def mutate_trees(name, text):
    """(name of the mutation, path that it touches, text) of every structured edit of one file."""
    edits = {"remove": remove, "rename": rename, "duplicate": duplicate}
    edits.update(
        {kind: lambda parent, index, make=make: replace(parent, index, make()) for kind, make in REPLACEMENTS.items()}
    )
    count = len(list(list_values(yaml.compose(text))))
    for kind, edit in edits.items():
        for place in choose(range(count), PLACES, f"{name} {kind}"):
            tree = yaml.compose(text)
            path, parent, index = list(list_values(tree))[place]
            if kind in ("rename", "duplicate") and not isinstance(parent, yaml.MappingNode):
                continue
            edit(parent, index)
            shown = ".".join(map(str, path))
            yield f"{name}: {kind} at {shown}", shown, yaml.serialize(tree, width=10**9).encode()


def set_value(text, path, value):
    tree = yaml.compose(text)
    *above, last = path.split(".")
    node = tree
    for step in above:
        found = (
            [item for key, item in node.value if key.value == step]
            if isinstance(node, yaml.MappingNode)
            else [node.value[int(step)]]
        )
        if not found:
            found = [yaml.MappingNode("tag:yaml.org,2002:map", [])]
            node.value.append((plain(step), found[0]))
        node = found[0]
    if isinstance(node, yaml.MappingNode):
        node.value = [(key, item) for key, item in node.value if key.value != last]
        node.value.append((plain(last), plain(value)))
    else:
        node.value[int(last)] = plain(value)
    return yaml.serialize(tree, width=10**9).encode()


# Sizes that a rule or the budget of memory has to stop, or that cost nothing.
HUGE = {
    "simulation.duration": ["1e12", "1e300", "1e-300"],
    "simulation.max_steps": ["10000000", "1", "1000000000"],
    "simulation.max_wall_time": ["1e300", "1e-300"],
    "simulation.relative_tolerance": ["1e-300", "1e300"],
    "simulation.absolute_tolerance": ["1e-300", "1e300"],
    "design.train.samples": ["1000000000", "10000000", "100000", "1"],
    "design.test.samples": ["1000000000", "10000000", "2", "3"],
    "design.train": ["{method: nested_latin_hypercube, samples: 40, smallest: 10000000}"],
    "features.0.samples.count": ["1000000000", "10000000", "100000"],
    "features.0.samples.interval": ["1e-12", "1e-300"],
    "features.0": [
        "{samples: {outputs: [y, theta], start: 0, interval: 1e-7, count: 10000000}}",
        "{spectrum: {outputs: [y], window: {start: 0, interval: 1e-7, count: 10000000}, frequencies: [1]}}",
        "{extrema: {output: y, peaks: 10000000, window: {start: 0, interval: 0.05, count: 101}}}",
        "{modes: {count: 10000000, frequencies: true}}",
    ],
    "noise.replicates": ["1000000", "10000000", "1e18"],
    "noise.scale": ["1e308", "1e-308", "0", "1.50", "15e-1"],
    "noise.correlation": [
        "{y: {autoregression: [0.99999999999]}}",
        "{y: {values: [1, 0.5], sample_time: 1e-300}}",
        "{y: {values: [1, 0.5], sample_time: 1e-9}}",
    ],
    "evaluation.posterior": ["{samples: 10000000}", "{draws: 10000000}", "{samples: 2, draws: 200}"],
    "evaluation.baselines": ["[{least_squares: {samples: 10000000, max_simulations: 10000000}}]"],
    "inverse_map.gp.starts": ["10000000"],
    "inverse_map.gp.max_evaluations": ["10000000"],
    "inverse_map.gp": [
        "{approximation: sgpr, inducing: 10000000}",
        "{approximation: sgpr, subset: 10000000}",
        "{approximation: sgpr, refine_evaluations: 10000000}",
    ],
    "inverse_map.gp.bounds": ["{length_scale: [1e-300, 1e300]}", "{noise_stddev: [1e-300, 1e300]}"],
    "transform": [
        "[{principal_components: {components: 10000000}}]",
        "[whiten, {select: {fisher_information: {count: 10000000}}}]",
        "[{select: {mutual_information: {count: 10000000, neighbours: 10000000}}}]",
        "[]",
        "[{partial_least_squares: {components: 10000000}}]",
    ],
    "sweep": [
        "{over: {seed: 1..100000}}",
        "{over: {seed: -9000000000000000000..9000000000000000000}}",
        "{over: {seed: 1..1000, noise.scale: 1..1000}}",
        "{over: {seed: []}}",
        "{over: {name: [a, b]}}",
        "{over: {description: [a, b]}}",
        "{over: {'system.springs[99999999999999999999].stiffness': [1, 2]}}",
    ],
    "seed": ["9007199254740993", "-1", "0", "9007199254740991"],
    "excitation.F.pulses": ["[{amplitude: 1e300, start: 0, end: 1}]", "[{amplitude: 1, start: -1e300, end: 1e300}]"],
    "excitation.F": [
        "{sines: [{amplitude: 5, frequency: 1e12}]}",
        "{tables: [{measured: {file: /dev/zero, column: F, time: t}}]}",
        "{tables: [{measured: {file: /no/such, column: F, time: t}}]}",
    ],
    "parameters.k_y.bounds": [
        "[-1e308, 1e308]",
        "[1e-320, 1e308]",
        "[5, 5.000000000000001]",
        "[15, 5]",
        "[5, 15, 20]",
        "[5., 1.5e1]",
        "[14, 15]",
    ],
    "constants.m1.value": [
        "-1",
        "0",
        "1/0",
        "1e-300",
        "m2 / 0",
        "sqrt(-1)",
        "1e308 * 10",
        ".33e1",
        "3.3 * 1",
        "max(m2, 3.3)",
        "1e3",
        "m2 > 1 ? -1 : 3.3",
    ],
    "system.gravity": ["[0, 0, 1e300]", "[0, 0]", "[0, 0, 0]", "[0, g / 2, -g]"],
}


def mutate_sizes(name, text):
    for path, values in HUGE.items():
        for value in values:
            yield f"{name}: {path} = {value}", path, set_value(text, path, value)


def mutate_text(name, text):
    """Edits of the file as bytes; `text` is a block-style file whose top-level keys begin their lines."""
    data = text.encode()
    deep = 10_000
    laughs = b"a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + b"".join(
        f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n".encode() for i in range(1, 12)
    )
    path_bomb = b'? "' + b"k" * 1_000_000 + b'"\n: [' + b"1, " * 100_000 + b"1]\n"
    edits = {
        "empty": b"",
        "only a comment": b"# nothing\n",
        "only a newline": b"\n",
        "only dashes": b"---\n",
        "only spaces": b"   \n  ",
        "a scalar": b"42\n",
        "a list": b"- 1\n- 2\n",
        "null document": b"~\n",
        "two documents": data + b"---\n" + data,
        "ended document": data + b"...\n",
        "started document": b"---\n" + data,
        "directive": b"%YAML 1.2\n---\n" + data,
        "unknown directive": b"%FOO bar\n---\n" + data,
        "garbage after the end": data + b"...\ngarbage: [\n",
        "CRLF": data.replace(b"\n", b"\r\n"),
        "CR": data.replace(b"\n", b"\r"),
        "no newline at the end": data.rstrip(b"\n"),
        "byte order mark": b"\xef\xbb\xbf" + data,
        "UTF-16": text.encode("utf-16"),
        "UTF-16-BE": text.encode("utf-16-be"),
        "UTF-32": text.encode("utf-32"),
        "Latin-1": data + "description: Stäbe\n".encode("latin-1"),
        "Latin-1 comment": data + "# Stäbe\n".encode("latin-1"),
        "NUL": data.replace(b"seed", b"se\0ed"),
        "NUL at the end": data + b"\0",
        "binary": bytes(range(256)) * 16,
        "random bytes": random.Random(name).randbytes(4096),
        "invalid UTF-8": data.replace(b"name: ", b"name: \xff\xfe"),
        "overlong UTF-8": data + b"# \xc0\x80\n",
        "surrogates": data + b"# \xed\xa0\x80\n",
        "truncated UTF-8": data + b"# \xe2\x82",
        "control character": data.replace(b"seed: ", b"seed: \x01"),
        "tab": data.replace(b"\n  ", b"\n\t", 1),
        "tab before a value": data.replace(b"seed: ", b"seed:\t"),
        "tab in a list": data + b"gates:\n\t- {metric: mare, max: 1}\n",
        "wrong indentation": data.replace(b"\n  ", b"\n ", 1),
        "unclosed bracket": data + b"gates: [1, 2\n",
        "unclosed quote": data + b'description: "abc\n',
        "unmatched bracket": data + b"gates: 1]\n",
        "deep flow lists": data + b"gates: " + b"[" * deep + b"]" * deep + b"\n",
        "deep open lists": data + b"gates: " + b"[" * deep + b"\n",
        "deep flow maps": data + b"gates: " + b"{a: " * deep + b"1" + b"}" * deep + b"\n",
        "deep block lists": data + b"gates:\n" + b"- " * deep + b"1\n",
        "deep block maps": data + b"gates:\n" + b"".join(b" " * i + b"a:\n" for i in range(1, 1000)),
        "deep explicit keys": data + b"? " * deep + b"a\n",
        "40 levels": data + b"gates: " + b"[" * 40 + b"]" * 40 + b"\n",
        "anchor and alias": data + b"noise_of_springs: &n 1\nx: *n\n",
        "anchored text": data.replace(b"name: ", b"name: &n ", 1) + b"description: *n\n"
        if b"description" not in data
        else data.replace(b"name: ", b"name: &n ", 1),
        "unknown alias": data + b"gates: *nothing\n",
        "recursive alias": data + b"gates: &a [*a]\n",
        "recursive map": data + b"gates: &a {b: *a}\n",
        "anchor as a key": data + b"&a gates: []\n",
        "billion laughs": laughs + data,
        "billion laughs below": data + laughs,
        "merge key": data + b"x: &x {a: 1}\ngates: {<<: *x}\n",
        "merge list": data + b"gates: [{<<: [{metric: mare}], max: 1}]\n",
        "quoted merge key": data + b"gates: [{'<<': 1}]\n",
        "tag": data + b"gates: !!binary aGVsbG8=\n",
        "own tag": data + b"gates: !mine [1]\n",
        "tagged number": data.replace(b"seed: ", b"seed: !!int "),
        "non-specific tag": data.replace(b"seed: ", b"seed: ! "),
        "list as a key": data + b"? [1, 2]\n: 3\n",
        "map as a key": data + b"{a: 1}: 3\n",
        "null as a key": data + b"~: 3\n",
        "empty key": data + b"'': 3\n",
        "number as a key": data + b"3: 3\n",
        "key without a value": data + b"gates\n",
        "long key": data + b"k" * 100_000 + b": 1\n",
        "many keys": data + b"".join(b"k%d: 1\n" % i for i in range(100_000)),
        "long key with many values": data + path_bomb,
        "many values": data + b"gates: [" + b"1, " * 1_200_000 + b"1]\n",
        "many constants": data.replace(
            b"constants:\n", b"constants:\n" + b"".join(b"  c%d: 1\n" % i for i in range(50_000)), 1
        ),
        "many expressions": data.replace(
            b"constants:\n",
            b"constants:\n  c0: 1\n" + b"".join(b"  c%d: c%d + 1\n" % (i, i - 1) for i in range(1, 3000)),
            1,
        ),
        "many outputs": data.replace(b"outputs: [", b"outputs: [" + b"y, " * 50_000, 1),
        "block text": data + b"description: |\n  several\n  lines\n" if b"description" not in data else data,
        "too large": data + b"# " + b"x" * (17 << 20) + b"\n",
        "many comments": b"# x\n" * 200_000 + data,
    }
    for kind, mutated in edits.items():
        yield f"{name}: {kind}", "", mutated
    for share in range(1, 10):
        yield f"{name}: the first {share} tenths", "", data[: len(data) * share // 10]
    for i, place in enumerate(choose(range(len(data)), 20, name)):
        byte = random.Random(i).randrange(256)
        yield f"{name}: byte {place} is {byte}", "*", data[:place] + bytes([byte]) + data[place + 1 :]
