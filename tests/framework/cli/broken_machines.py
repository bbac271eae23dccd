"""More mistakes in experiments, as in broken_inputs.py: in the mechanics, the controllers, the priors and the settings."""
from broken_inputs import find_coordinate, pick


def find_samples(tree):
    return next(feature["samples"] for feature in tree["features"] if "samples" in feature)


def add_force(tree, force):
    """A law on the first coordinate; returns how messages call its force."""
    laws = tree["system"].setdefault("force_laws", [])
    laws.append({"coordinate": find_coordinate(tree), "force": force})
    return rf"force_laws\[{len(laws) - 1}\]\.force"


def add_controller(tree, **changes):
    controller = {
        "sample_time": 1e-3,
        "reads": {"y_read": pick_output(tree)},
        "writes": {"u_held": {"value": "-y_read"}},
    }
    tree["system"]["controllers"] = {"loop": {**controller, **changes}}


def pick_output(tree):
    return sorted(tree["outputs"])[0]


def misspell_stiffness(_generator, tree):
    tree["system"].setdefault("springs", []).append({"coordinate": find_coordinate(tree), "stifness": 3})
    return "'stifness' is not a key here; did you mean 'stiffness'"


def misspell_stddev(_generator, tree):
    tree["noise"]["stdev"] = tree["noise"].pop("stddev")
    return "'stdev' is not a key here; did you mean 'stddev'"


def misspell_joint(generator, tree):
    tree["system"]["bodies"][pick(generator, tree["system"]["bodies"])]["joint"]["type"] = "pinn"
    return "'pinn' must be .*pin"


def use_hinge(generator, tree):
    tree["system"]["bodies"][pick(generator, tree["system"]["bodies"])]["joint"]["type"] = "revolute"
    return "'revolute' must be .*pin"


def sample_never(_generator, tree):
    add_controller(tree, sample_time=0)
    return r"controllers\.loop\.sample_time.*'?0'? must be"


def sample_into_the_past(_generator, tree):
    add_controller(tree, delay=-1e-3)
    return r"controllers\.loop\.delay.*-0\.001 s must not be negative"


def read_no_signal(_generator, tree):
    add_controller(tree, reads={"y_read": "tachometer"})
    return r"controllers\.loop\.reads\.y_read.*'tachometer' is not"


def write_unknown_name(_generator, tree):
    add_controller(tree, writes={"u_held": {"value": "-gain_nobody_gave * y_read"}})
    return r"controllers\.loop\.writes\.u_held.*'gain_nobody_gave'"


def write_a_parameter(generator, tree):
    name = pick(generator, tree["parameters"])
    add_controller(tree, writes={name: {"value": "-y_read"}})
    return rf"'{name}' is taken"


def span_too_far(_generator, tree):
    bodies = sorted(tree["system"]["bodies"])
    rod = {
        "from": {"body": bodies[-1], "point": [0.01, 0, 0]},
        "to": {"body": "ground", "point": [0, 0, 0]},
        "length": 90,
    }
    tree["system"].setdefault("constraints", []).append({"rod": rod, "name": "strut"})
    return "strut|constraints"


def join_no_body(_generator, tree):
    ends = {"from": {"body": sorted(tree["system"]["bodies"])[0]}, "to": {"body": "nobody"}}
    tree["system"].setdefault("constraints", []).append({"coincident": ends})
    return r"constraints\[\d\].*'nobody' is not a body"


def equal_bounds(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"][1] = tree["parameters"][name]["bounds"][0]
    return rf"parameters\.{name}\.bounds.*(lower|below)"


def third_bound(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"].append(7)
    return rf"parameters\.{name}\.bounds.*2"


def bounds_as_text(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["bounds"] = "5..15"
    return rf"parameters\.{name}\.bounds.*list"


def decimal_comma(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["mass"] = "1,5"
    return rf"bodies\.{name}\.mass.*'1,5'.*(comma|character|point)"


def unit_in_number(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["mass"] = "1.5 kg"
    return rf"bodies\.{name}\.mass.*'1\.5 kg'"


def misspell_unit(generator, tree):
    name = pick(generator, {k: v for k, v in tree["parameters"].items() if "unit" in v})
    tree["parameters"][name]["unit"] = "Newtonmeters"
    return rf"parameters\.{name}\.unit.*'Newtonmeters' is not a unit"


def output_in_mm(_generator, tree):
    name = pick_output(tree)
    tree["outputs"][name]["unit"] = "mm"
    return rf"outputs\.{name}.*has the unit of what it measures"


def no_duration(_generator, tree):
    tree["simulation"]["duration"] = 0
    return r"simulation\.duration.*(0|must be)"


def backwards_in_time(_generator, tree):
    tree["simulation"]["duration"] = -3
    return r"simulation\.duration.*'?-3'? must be"


def count_half(_generator, tree):
    find_samples(tree)["count"] = 12.5
    return r"count.*'12\.5' must be a whole number"


def count_none(_generator, tree):
    find_samples(tree)["count"] = 0
    return r"count.*'0' must be"


def noise_of_nothing(_generator, tree):
    tree["noise"]["stddev"]["gyro"] = 1e-3
    return r"noise\.stddev\.gyro.*'gyro' is not an output"


def too_many_names(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    joint = tree["system"]["bodies"][name]["joint"]
    joint["coordinates"] = [*joint.get("coordinates", []), "extra_1", "extra_2"]
    return rf"bodies\.{name}: .* in joint\.coordinates, of a joint with"


def same_name_twice(_generator, tree):
    tree.setdefault("constants", {})[sorted(tree["parameters"])[0]] = 3
    return rf"'{sorted(tree['parameters'])[0]}' is taken"


def name_with_blank(_generator, tree):
    tree["parameters"]["spring rate"] = {"bounds": [1, 2]}
    return "'spring rate'.*letters"


def end_before_start(_generator, tree):
    signal = sorted(tree["excitation"])[0]
    tree["excitation"][signal]["pulses"] = [{"amplitude": 1, "start": 0.5, "end": 0.2}]
    return rf"excitation\.{signal}\.pulses\[0\].*end"


def table_backwards(_generator, tree):
    signal = sorted(tree["excitation"])[0]
    tree["excitation"][signal]["tables"] = [{"times": [0, 2, 1], "values": [0, 1, 2]}]
    return rf"excitation\.{signal}\.tables\[0\].*increasing times"


def table_of_two_lengths(_generator, tree):
    signal = sorted(tree["excitation"])[0]
    tree["excitation"][signal]["tables"] = [{"times": [0, 1, 2], "values": [0, 1]}]
    return rf"excitation\.{signal}\.tables\[0\].*as many values as times"


def table_without_file(_generator, tree):
    signal = sorted(tree["excitation"])[0]
    tree["excitation"][signal]["tables"] = [{"measured": {"file": "lost.csv", "column": "F", "time": "t"}}]
    return r"lost\.csv.*(not exist|no such file)"


def start_nowhere(_generator, tree):
    tree["initial"] = {"coordinates": {"zeta": 0.1}}
    return r"initial\.coordinates\.zeta.*'zeta' is not a coordinate"


def friction_unknown(_generator, tree):
    tree["system"]["friction"] = [{"coordinate": find_coordinate(tree), "model": "dahl", "coulomb": 1}]
    return r"friction\[0\]\.model.*'dahl' must be .*coulomb"


def friction_without_onset(_generator, tree):
    tree["system"]["friction"] = [{"coordinate": find_coordinate(tree), "model": "regularised", "coulomb": 1}]
    return r"friction\[0\].*onset_speed"


def friction_without_bristle(_generator, tree):
    tree["system"]["friction"] = [{"coordinate": find_coordinate(tree), "model": "lugre", "coulomb": 1}]
    return r"friction\[0\].*bristle"


def sweep_nothing(_generator, tree):
    tree["sweep"] = {"over": {"design.train.sample": [50, 100]}}
    return r"'sample' is not a key here; did you mean 'samples'"


def prior_too_narrow(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["prior"] = {"normal": {"mean": 1, "stddev": -1}}
    return rf"parameters\.{name}\.prior\.normal\.stddev.*'-1' must be"


def prior_far_away(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["prior"] = {"normal": {"mean": 1e6, "stddev": 1}}
    return rf"parameters\.{name}.*prior"


def prior_of_no_kind(generator, tree):
    name = pick(generator, tree["parameters"])
    tree["parameters"][name]["prior"] = "gaussian"
    return rf"parameters\.{name}\.prior.*'gaussian'"


def engine_of_the_future(_generator, tree):
    tree["simulation"]["engine"] = "gpu"
    return r"simulation\.engine.*'gpu' must be"


def tolerance_negative(_generator, tree):
    tree["simulation"]["relative_tolerance"] = -1e-6
    return r"simulation\.relative_tolerance.*'-1.*' must be"


def test_by_hand(_generator, tree):
    tree["design"] = {"test": {"method": "by_hand", "samples": 100}}
    return r"design\.test\.method.*'by_hand' must be"


def gravity_as_number(_generator, tree):
    tree["system"]["gravity"] = -9.81
    return r"system\.gravity.*list"


def inertia_negative(generator, tree):
    name = pick(generator, {k: v for k, v in tree["system"]["bodies"].items() if v["joint"]["type"] == "pin"})
    tree["system"]["bodies"][name]["inertia"] = -1e-3
    return rf"bodies\.{name}.*inertia.*(positive|negative|below 0)"


def mass_nothing(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["mass"] = 0
    return rf"bodies\.{name}\.mass.* 0 kg must be positive"


def call_no_function(_generator, tree):
    return add_force(tree, f"-2 * sgn({find_coordinate(tree)}_dot)") + ".*'sgn'"


def python_power(_generator, tree):
    return add_force(tree, f"-2 * {find_coordinate(tree)} ** 3") + r".*(\^|character|\*\*)"


def divide_by_zero(_generator, tree):
    return add_force(tree, "1 / 0") + ".*(finite|zero|infinite)"


def misspell_speed(_generator, tree):
    name = find_coordinate(tree)
    return add_force(tree, f"-2 * {name}_dott") + f".*'{name}_dott'"


def derive_from_nothing(_generator, tree):
    tree["derived"] = {"f_1": {"value": "sqrt(stiffnes / 2)"}}
    return r"derived\.f_1.*'stiffnes'"


def gate_unknown(_generator, tree):
    tree["gates"] = [{"metric": "coverage95", "parameter": "nobody", "min": 0.9}]
    return r"gates\[0\].*'nobody'"


def over_unknown(_generator, tree):
    tree["report"] = {"over": ["nobody", "somebody"]}
    return r"report\.over.*'nobody'"


def measure_unknown(_generator, tree):
    tree["measurement"] = {"columns": {"gyro": "acc"}}
    return r"measurement\.columns\.gyro.*'gyro' is not an output"


def trial_unknown_key(_generator, tree):
    tree["trials"] = {"a": {"excitations": {}}}
    return r"trials\.a.*'excitations'.*did you mean 'excitation'"


def parent_unknown(generator, tree):
    name = pick(generator, tree["system"]["bodies"])
    tree["system"]["bodies"][name]["joint"]["parent"] = "nobody"
    return rf"bodies\.{name}\.joint\.parent.*'nobody'"


def output_of_nothing(_generator, tree):
    name = pick_output(tree)
    tree["outputs"][name] = {"coordinate": "nowhere"}
    return rf"outputs\.{name}.*'nowhere' is not a coordinate"


def output_of_two(_generator, tree):
    name = pick_output(tree)
    tree["outputs"][name] = {"coordinate": find_coordinate(tree), "speed": find_coordinate(tree)}
    return rf"outputs\.{name}"


def noise_scale_text(_generator, tree):
    tree["noise"]["scale"] = "high"
    return r"noise\.scale.*'high' must be a number"


def steps_none(_generator, tree):
    tree["simulation"]["max_steps"] = 0
    return r"simulation\.max_steps.*'0' must be"


def spring_in_list(_generator, tree):
    tree["system"]["springs"] = {"coordinate": find_coordinate(tree), "stiffness": 1}
    return r"system\.springs.*must be a list"


def seed_negative(_generator, tree):
    tree["seed"] = -4
    return "seed.*'-4' must be"


def stop_both_sides(_generator, tree):
    tree["system"]["stops"] = [{"coordinate": find_coordinate(tree), "stiffness": 1e3}]
    return r"stops\[0\].*(above|below)"


def gap_negative(_generator, tree):
    tree["system"]["backlash"] = [{"coordinate": find_coordinate(tree), "gap": -1e-3, "stiffness": 1e3}]
    return r"backlash\[0\]\.gap.*-0\.001"


def turn_frequency(_generator, tree):
    signal = sorted(tree["excitation"])[0]
    tree["excitation"][signal]["sines"] = [{"amplitude": 1, "frequency": -2}]
    return rf"excitation\.{signal}\.sines\[0\]\.frequency.*-2 Hz must be positive"


MACHINE_FAULTS = [
    misspell_stiffness,
    misspell_stddev,
    misspell_joint,
    use_hinge,
    sample_never,
    sample_into_the_past,
    read_no_signal,
    write_unknown_name,
    write_a_parameter,
    span_too_far,
    join_no_body,
    equal_bounds,
    third_bound,
    bounds_as_text,
    decimal_comma,
    unit_in_number,
    misspell_unit,
    output_in_mm,
    no_duration,
    backwards_in_time,
    count_half,
    count_none,
    noise_of_nothing,
    too_many_names,
    same_name_twice,
    name_with_blank,
    end_before_start,
    table_backwards,
    table_of_two_lengths,
    table_without_file,
    start_nowhere,
    friction_unknown,
    friction_without_onset,
    friction_without_bristle,
    sweep_nothing,
    prior_too_narrow,
    prior_far_away,
    prior_of_no_kind,
    engine_of_the_future,
    tolerance_negative,
    test_by_hand,
    gravity_as_number,
    inertia_negative,
    mass_nothing,
    call_no_function,
    python_power,
    divide_by_zero,
    misspell_speed,
    derive_from_nothing,
    gate_unknown,
    over_unknown,
    measure_unknown,
    trial_unknown_key,
    parent_unknown,
    output_of_nothing,
    output_of_two,
    noise_scale_text,
    steps_none,
    spring_in_list,
    seed_negative,
    stop_both_sides,
    gap_negative,
    turn_frequency,
]
