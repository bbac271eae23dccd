"""Mistakes in experiments and recordings, each with what a message about it must contain (a regular expression)."""
import yaml

from support import EXPERIMENTS

# What experiments are broken of; recordings are of the first two.
MACHINES = ["duffing/cart", "two_beam/best", "crane/crane", "mechanisms/slider_crank", "mechanisms/stick_slip"]


def load(name):
    return yaml.safe_load((EXPERIMENTS / f"{name}.yaml").read_text())


def pick(generator, mapping):
    return generator.choice(sorted(mapping))


# Each takes a generator and an experiment, which it breaks, and returns what the message must contain (a regular expression).


def remove_section(generator, tree):
    key = generator.choice([key for key in ("parameters", "features", "noise", "name") if key in tree])
    del tree[key]
    return f"needs the key '{key}'"


def remove_bounds(generator, tree):
    name = pick(generator, tree["parameters"])
    del tree["parameters"][name]["bounds"]
    return rf"parameters\.{name}.*bounds"


def remove_joint(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    del tree["system"]["bodies"][name]["joint"]
    return rf"bodies\.{name}: needs the key 'joint'"


def misspell_section(generator, tree):
    key = generator.choice(
        [key for key in ("parameters", "outputs", "features", "simulation", "excitation") if key in tree]
    )
    tree[key[:-1]] = tree.pop(key)
    return f"'{key[:-1]}' is not a key here; did you mean '{key}'"


def misspell_bounds(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bound"] = tree["parameters"][name].pop("bounds")
    return rf"parameters\.{name}.*'bound' is not a key here; did you mean 'bounds'"


def state_other_unit(generator, tree):
    name = pick(generator, {k: v for k, v in tree["parameters"].items() if "unit" in v})
    tree["parameters"][name]["unit"] = "N/mm"
    return "N/mm.*coherent|N/mm"


def state_wrong_unit(generator, tree):
    name = pick(generator, {k: v for k, v in tree["parameters"].items() if "unit" in v})
    tree["parameters"][name]["unit"] = "K"
    return rf"\b{name}\b.*unit|unit.*\bK\b"


def leave_unused(generator, tree):
    tree["parameters"]["spare"] = {"bounds": [1, 2]}
    return r"parameters\.spare: nothing uses this parameter"


def turn_bounds(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"].reverse()
    return rf"parameters\.{name}\.bounds.*lower"


def put_nan(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"][1] = float("nan")
    return rf"parameters\.{name}\.bounds.*nan.*number"


def put_text(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"][0] = "about 5"
    return rf"parameters\.{name}\.bounds.*'about 5' must be a number"


def turn_mass(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["mass"] = -2
    return rf"bodies\.{name}\.mass.*-2.*must be positive"


def refer_in_a_circle(_generator, tree):
    tree.setdefault("constants", {}).update({"loop_a": {"value": "loop_b + 1"}, "loop_b": {"value": "loop_a + 1"}})
    return "loop_a.*'loop_b', which is declared only after it"


def hang_on_itself(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["joint"]["parent"] = name
    return rf"bodies\.{name}\.joint\.parent.*'{name}'"


def name_no_coordinate(_generator, tree):
    tree["system"].setdefault("springs", []).append({"coordinate": "nowhere", "stiffness": 1})
    return "'nowhere' is not a coordinate"


def name_no_parameter(_generator, tree):
    coordinate = find_coordinate(tree)
    tree["system"].setdefault("springs", []).append({"coordinate": coordinate, "stiffness": "2 * unheard_of"})
    return "'unheard_of'"


def open_a_parenthesis(_generator, tree):
    tree["system"].setdefault("springs", []).append({"coordinate": find_coordinate(tree), "stiffness": "2 * (3 + 4"})
    return r"stiffness.*2 \* \(3 \+ 4.*(parenthes|'\)'|character)"


def negate_noise(generator, tree):
    name = pick(generator, tree["noise"]["stddev"])
    tree["noise"]["stddev"][name] = -1e-3
    return rf"noise\.stddev\.{name}.*'-0\.001' must"


def forget_noise(generator, tree):
    name = pick(generator, tree["noise"]["stddev"])
    del tree["noise"]["stddev"][name]
    return rf"{name}.*noise\.stddev|noise\.stddev.*{name}"


def end_early(_generator, tree):
    tree["simulation"]["duration"] = 1e-3
    return "duration"


def forget_duration(_generator, tree):
    del tree["simulation"]["duration"]
    return r"simulation\.duration: must be given"


def read_no_output(_generator, tree):
    samples = next(feature["samples"] for feature in tree["features"] if "samples" in feature)
    samples["outputs"] = ["unseen"]
    return "'unseen' is not an output"


def take_no_estimator(_generator, tree):
    tree["inverse_map"] = "magic"
    return r"inverse_map.*'magic'.*(surrogate|must be)"


def take_one_sample(_generator, tree):
    tree["design"] = {"train": {"samples": 1}}
    return "design.*at least 2 training"


def weaken_gravity(_generator, tree):
    tree["system"]["gravity"] = [0, -9.81]
    return r"gravity.*(3|three)"


def give_output_as_text(generator, tree):
    name = pick(generator, tree["outputs"])
    tree["outputs"][name] = "q"
    return rf"outputs\.{name}: 'q' must be a map, such as"


def widen_inertia(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["inertia"] = {"moments": [0, 0, 5]}
    return rf"bodies\.{name}\.inertia.*the other two"


def sample_backwards(_generator, tree):
    samples = next(feature["samples"] for feature in tree["features"] if "samples" in feature)
    samples["interval"] = -0.01
    return r"interval.*'-0\.01' must be"


def find_coordinate(tree):
    return next(c for body in tree["system"]["bodies"].values() for c in body["joint"].get("coordinates", []))


EXPERIMENT_FAULTS = [
    remove_section,
    remove_bounds,
    remove_joint,
    misspell_section,
    misspell_bounds,
    state_other_unit,
    state_wrong_unit,
    leave_unused,
    turn_bounds,
    put_nan,
    put_text,
    turn_mass,
    refer_in_a_circle,
    hang_on_itself,
    name_no_coordinate,
    name_no_parameter,
    open_a_parenthesis,
    negate_noise,
    forget_noise,
    end_early,
    forget_duration,
    read_no_output,
    take_no_estimator,
    take_one_sample,
    weaken_gravity,
    give_output_as_text,
    widen_inertia,
    sample_backwards,
]


# (name, edit of the file's bytes, what the message must contain)
TEXT_FAULTS = [
    ("empty", lambda data: b"", "is empty"),
    ("binary", lambda data: bytes(range(256)) * 8, "UTF-8|NUL|control character|not text"),
    ("utf-16", lambda data: data.decode().encode("utf-16"), "UTF-8|UTF-16"),
    ("tab", lambda data: data.replace(b"\n  ", b"\n\t", 1), "tab"),
    ("repeated key", lambda data: data + b"\nparameters: {}\n", "'parameters'.*(twice|repeated|again)"),
    ("open bracket", lambda data: data + b"\ngates: [1, 2\n", r"'\[' is not closed"),
]


# Recordings: each takes a generator and rows (a header, then numbers), changes them, and returns what must be said.


def read_rows(path):
    lines = path.read_text().splitlines()
    return [lines[0].split(",")] + [[float(cell) for cell in line.split(",")] for line in lines[1:]]


def choose_output(generator, rows):
    return generator.randrange(1, len(rows[0]))


def scale_output(factor, said):
    def fault(generator, rows):
        i = choose_output(generator, rows)
        for row in rows[1:]:
            row[i] *= factor
        return rf"{rows[0][i]} is {said}"

    fault.__name__ = f"scale_output_{factor:g}"
    return fault


def add_offset(generator, rows):
    i = choose_output(generator, rows)
    offset = 5 * max(abs(row[i]) for row in rows[1:])
    for row in rows[1:]:
        row[i] += offset
    return rf"{rows[0][i]} (has an offset of|reads) "


def add_spike(generator, rows):
    i = choose_output(generator, rows)
    height = 30 * max(abs(row[i]) for row in rows[1:])
    row = generator.randrange(10, len(rows) - 10)
    rows[row][i] += height
    return rf"{rows[0][i]}.*{rows[row][0]:.4g} s"


def write_degrees(_generator, rows):
    for row in rows[1:]:
        row[2] *= 57.29577951308232
    return "theta is 57.3 times too large"


def swap_outputs(_generator, rows):
    for row in rows[1:]:
        row[1], row[2] = row[2], row[1]
    return "columns of .* are swapped"


def hold_output(generator, rows):
    i = choose_output(generator, rows)
    for row in rows[1:]:
        row[i] = 0.25
    return rf"{rows[0][i]}.*constant signal"


def clip_output(generator, rows):
    i = choose_output(generator, rows)
    limit = 0.4 * max(abs(row[i]) for row in rows[1:])
    for row in rows[1:]:
        row[i] = min(max(row[i], -limit), limit)
    return rf"{rows[0][i]} is clipped in \d+ samples"


def drop_output(generator, rows):
    i = choose_output(generator, rows)
    name = rows[0][i]
    for row in rows:
        del row[i]
    return f"no column '{name}'"


def rename_output(generator, rows):
    i = choose_output(generator, rows)
    name, rows[0][i] = rows[0][i], rows[0][i] + "_raw"
    return f"no column '{name}'"


def repeat_column(generator, rows):
    i = choose_output(generator, rows)
    for row in rows:
        row.append(row[i])
    return rf"'{rows[0][i]}'.*(twice|2 columns|repeated)"


def state_no_length(generator, rows):
    i = choose_output(generator, rows)
    rows[0][i] += " [kg]"
    return "kg.*does not convert|kg"


def lose_header(_generator, rows):
    del rows[0]
    return "header|names? the columns|no column"


def start_late(_generator, rows):
    del rows[1:8]
    return "begins at|left out"


def end_half_way(_generator, rows):
    del rows[len(rows) // 2 :]
    return "ends at|left out"


def shift_far(_generator, rows):
    for row in rows[1:]:
        row[0] += 1000
    return "no sample at any needed time.*--start|begins at 1000.*--start"


def in_milliseconds(_generator, rows):
    for row in rows[1:]:
        row[0] *= 1000
    return "(begins|ends|sample each).* s|t \\[ms\\]"


def write_a_word(generator, rows):
    i, row = choose_output(generator, rows), generator.randrange(2, len(rows))
    rows[row][i] = "over"
    return f":{row + 1}:.*'over'.*number"


def write_infinity(generator, rows):
    i, row = choose_output(generator, rows), generator.randrange(2, len(rows))
    rows[row][i] = "inf"
    return f":{row + 1}:.*'inf'"


def lose_a_cell(generator, rows):
    row = generator.randrange(2, len(rows))
    rows[row].pop()
    return f":{row + 1}:.*cells?"


def add_a_cell(generator, rows):
    row = generator.randrange(2, len(rows))
    rows[row].append(1.0)
    return f":{row + 1}:.*cells?"


ROW_FAULTS = [
    scale_output(1000.0, "1000 times too large"),
    scale_output(1e-3, "1000 times too small"),
    scale_output(-1.0, "of the other sign"),
    add_offset,
    add_spike,
    hold_output,
    clip_output,
    drop_output,
    rename_output,
    repeat_column,
    state_no_length,
    lose_header,
    start_late,
    end_half_way,
    shift_far,
    in_milliseconds,
    write_a_word,
    write_infinity,
    lose_a_cell,
    add_a_cell,
]
# Of the two beams, whose second output is an angle.
BEAM_FAULTS = [swap_outputs, write_degrees]

# (name, edit of the file's text, what must be said)
FILE_FAULTS = [
    ("empty recording", lambda text: b"", "is empty|no header|has no"),
    ("binary recording", lambda text: bytes(range(256)) * 8, "NUL|not text|UTF-8|no column"),
    ("utf-16 recording", lambda text: text.encode("utf-16"), "UTF-16"),
    ("header alone", lambda text: text.split("\n")[0].encode() + b"\n", "no rows|0 samples|has 0|has no"),
    ("wrong separator", lambda text: text.replace(",", ":").encode(), "no column"),
]
