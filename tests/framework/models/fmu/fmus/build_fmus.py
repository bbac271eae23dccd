"""Builds the FMUs of the tests: build_fmus.py OUT CC HEADERS. Names: MODEL_VERSION.fmu, and the broken ones."""
import stat
import subprocess
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PLATFORM = {2: "linux64", 3: "x86_64-linux"}
TOKEN = {2: "{two-2}", 3: "{two-3}"}

# (name, value reference, type, causality, variability, {attributes})
TWO_BEAM = [
    ("y", 0, "Real", "output", "continuous", {"unit": "m"}),
    ("theta", 1, "Real", "output", "continuous", {"unit": "rad"}),
    ("v", 2, "Real", "local", "continuous", {"unit": "m/s"}),
    ("w", 3, "Real", "local", "continuous", {"unit": "rad/s"}),
    ("der(y)", 4, "Real", "local", "continuous", {"derivative": "y"}),
    ("der(theta)", 5, "Real", "local", "continuous", {"derivative": "theta"}),
    ("der(v)", 6, "Real", "local", "continuous", {"derivative": "v"}),
    ("der(w)", 7, "Real", "local", "continuous", {"derivative": "w"}),
    ("d_y", 8, "Real", "parameter", "fixed", {"start": "1", "unit": "N.s/m", "description": "damper of the slide"}),
    ("d_theta", 9, "Real", "parameter", "tunable", {"start": "2e-4"}),
    ("k_y", 10, "Real", "parameter", "fixed", {"start": "10", "unit": "N/m"}),
    ("k_theta", 11, "Real", "parameter", "fixed", {"start": "0.036", "unit": "N.m/rad"}),
    ("F", 12, "Real", "input", "continuous", {"start": "0", "unit": "N"}),
    ("M", 13, "Real", "input", "continuous", {"start": "0", "unit": "N.m"}),
    ("y_start", 14, "Real", "parameter", "fixed", {"start": "0", "unit": "m"}),
    ("theta_start", 15, "Real", "parameter", "fixed", {"start": "0", "unit": "rad"}),
]
BALL = [
    ("h", 0, "Real", "output", "continuous", {"start": "1", "initial": "exact", "unit": "m"}),
    ("v", 1, "Real", "output", "continuous", {"start": "0", "initial": "exact", "unit": "m/s"}),
    ("der(h)", 2, "Real", "local", "continuous", {"derivative": "h"}),
    ("der(v)", 3, "Real", "local", "continuous", {"derivative": "v"}),
    ("g", 4, "Real", "parameter", "fixed", {"start": "-9.81", "unit": "m/s2"}),
    ("e", 5, "Real", "parameter", "tunable", {"start": "0.7"}),
    ("twice", 20, "Real", "calculatedParameter", "fixed", {}),
    ("pi", 21, "Real", "local", "constant", {"start": "3.14"}),
]
OSCILLATOR = [
    ("x", 0, "Real", "output", "continuous", {"start": "0.1", "initial": "exact", "unit": "m"}),
    ("v", 1, "Real", "local", "continuous", {"start": "0", "initial": "exact", "unit": "m/s"}),
    ("der(x)", 2, "Real", "local", "continuous", {"derivative": "x"}),
    ("der(v)", 3, "Real", "local", "continuous", {"derivative": "v"}),
    ("c", 4, "Real", "parameter", "tunable", {"start": "40"}),
    ("d", 5, "Real", "parameter", "tunable", {"start": "0.5"}),
    ("F", 6, "Real", "input", "continuous", {"start": "0"}),
    ("p", 7, "Real", "output", "continuous", {}),
]
STAIRS = [("counter", 0, "Real", "output", "discrete", {"start": "1", "initial": "exact"})]
FEEDTHROUGH = [
    ("u", 0, "Real", "input", "continuous", {"start": "0"}),
    ("y", 1, "Real", "output", "continuous", {}),
    ("p", 2, "Real", "parameter", "fixed", {"start": "2", "unit": "mm"}),
    ("p_out", 3, "Real", "output", "continuous", {"unit": "mm"}),
    ("du", 4, "Real", "input", "discrete", {"start": "0"}),
    ("dy", 5, "Real", "output", "discrete", {}),
    ("i", 100, "Integer", "parameter", "fixed", {"start": "0"}),
    ("i_out", 101, "Integer", "output", "discrete", {}),
    ("kind", 104, "Enumeration", "parameter", "fixed", {"start": "1", "declaredType": "Kind"}),
    ("kind_out", 105, "Enumeration", "output", "discrete", {"declaredType": "Kind"}),
    ("flag", 200, "Boolean", "parameter", "fixed", {"start": "false"}),
    ("flag_out", 201, "Boolean", "output", "discrete", {}),
    ("text", 900, "String", "parameter", "fixed", {"start": "hello"}),
]
FEEDTHROUGH_3 = [
    ("size", 901, "UInt64", "structuralParameter", "fixed", {"start": "4"}),
    ("single", 300, "Float32", "parameter", "fixed", {"start": "0"}),
    ("single_out", 301, "Float32", "output", "continuous", {}),
    ("small", 102, "Int8", "parameter", "fixed", {"start": "0"}),
    ("small_out", 103, "Int8", "output", "discrete", {}),
    ("a", 400, "Float64", "parameter", "fixed", {"start": "1 2 3 4", "dimensions": ["901"]}),
    ("b", 401, "Float64", "output", "continuous", {"dimensions": ["901"]}),
    ("tick", 902, "Clock", "input", "discrete", {"intervalVariability": "triggered"}),
]
RESOURCE = [("y", 0, "Real", "output", "continuous", {})]
FAULTY = [
    ("x", 0, "Real", "output", "continuous", {"start": "1", "initial": "exact"}),
    ("der(x)", 1, "Real", "local", "continuous", {"derivative": "x"}),
    ("fault", 2, "Real", "parameter", "fixed", {"start": "0"}),
]

UNITS = """<UnitDefinitions>
  <Unit name="m"><BaseUnit m="1"/></Unit><Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
  <Unit name="rad"><BaseUnit rad="1"/></Unit><Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
  <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit><Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
  <Unit name="N/m"><BaseUnit kg="1" s="-2"/></Unit><Unit name="N.s/m"><BaseUnit kg="1" s="-1"/></Unit>
  <Unit name="N.m/rad"><BaseUnit kg="1" m="2" s="-2" rad="-1"/></Unit><Unit name="bananas"/></UnitDefinitions>"""
TYPES_3 = {"Real": "Float64", "Integer": "Int32"}


def attributes(values):
    return "".join(f' {key}="{value}"' for key, value in values.items())


def head_attributes(name, reference, causality, variability, extra, keys):
    own = {"name": name, "valueReference": reference, "causality": causality, "variability": variability}
    return own | {key: extra[key] for key in keys if key in extra}


def describe_2(variables, identifier, indicators, variable_step):
    names = [variable[0] for variable in variables]
    lines, derivatives = [], []
    for name, reference, kind, causality, variability, extra in variables:
        typed = {key: value for key, value in extra.items() if key not in ("initial", "description", "derivative")}
        if "derivative" in extra:
            typed["derivative"] = names.index(extra["derivative"]) + 1
            derivatives.append(names.index(name) + 1)
        head = head_attributes(name, reference, causality, variability, extra, ("initial", "description"))
        lines.append(f"<ScalarVariable{attributes(head)}><{kind}{attributes(typed)}/></ScalarVariable>")
    unknowns = "".join(f'<Unknown index="{i}"/>' for i in derivatives)
    kinds = "".join(
        f'<{kind} modelIdentifier="{identifier}"{more}/>'
        for kind, more in (
            ("ModelExchange", ""),
            ("CoSimulation", f' canHandleVariableCommunicationStepSize="{variable_step}"'),
        )
    )
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{identifier}" guid="{TOKEN[2]}" numberOfEventIndicators="{indicators}">
{kinds}{UNITS}<TypeDefinitions><SimpleType name="Kind"><Enumeration><Item name="one" value="1"/><Item name="two" value="2"/>
</Enumeration></SimpleType></TypeDefinitions><LogCategories><Category name="logStatusError"/></LogCategories>
<DefaultExperiment startTime="0" stopTime="5"/><ModelVariables>{chr(10).join(lines)}</ModelVariables>
<ModelStructure><Derivatives>{unknowns}</Derivatives></ModelStructure></fmiModelDescription>"""


def describe_3(variables, identifier, indicators, variable_step, early="false", events="false"):
    references = {variable[0]: variable[1] for variable in variables}
    lines, structure = [], ""
    for name, reference, kind, causality, variability, extra in variables:
        own = head_attributes(
            name,
            reference,
            causality,
            variability,
            extra,
            [key for key in extra if key not in ("derivative", "dimensions")],
        )
        if "derivative" in extra:
            own["derivative"] = references[extra["derivative"]]
            structure += f'<ContinuousStateDerivative valueReference="{reference}"/>'
        inside = "".join(f'<Dimension valueReference="{size}"/>' for size in extra.get("dimensions", []))
        if kind == "String":
            inside += f'<Start value="{own.pop("start")}"/>'
        if name == "y":
            inside += '<Alias name="position"/>'
        kind = TYPES_3.get(kind, kind)
        lines.append(f"<{kind}{attributes(own)}>{inside}</{kind}>")
    structure += "".join(f'<EventIndicator valueReference="0"/>' for _ in range(indicators))
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{identifier}" instantiationToken="{TOKEN[3]}">
<ModelExchange modelIdentifier="{identifier}" needsCompletedIntegratorStep="true"/>
<CoSimulation modelIdentifier="{identifier}" canHandleVariableCommunicationStepSize="{variable_step}"
 mightReturnEarlyFromDoStep="{early}" hasEventMode="{events}"/>
{UNITS}<TypeDefinitions><EnumerationType name="Kind"><Item name="one" value="1"/><Item name="two" value="2"/></EnumerationType>
</TypeDefinitions><LogCategories><Category name="logStatusError"/></LogCategories>
<DefaultExperiment startTime="0" stopTime="5"/><ModelVariables>{chr(10).join(lines)}</ModelVariables>
<ModelStructure>{structure}</ModelStructure></fmiModelDescription>"""


def offer_derivatives(xml):
    """Of OSCILLATOR; FMI 3.0 lists the tunable parameters that a state derivative depends on."""
    return xml.replace(
        "<ModelExchange ", '<ModelExchange providesDirectionalDerivatives="true" providesDirectionalDerivative="true" '
    ).replace(
        '<ContinuousStateDerivative valueReference="3"/>',
        '<ContinuousStateDerivative valueReference="3" '
        'dependencies="0 1 4 5 6"/><Output valueReference="7" dependencies="1 5"/>',
    )


def compile_model(out, compiler, headers, model, version, defines):
    library = out / f"{model}_{version}{''.join(defines)}.so"
    subprocess.run(
        [
            compiler,
            "-shared",
            "-fPIC",
            "-O2",
            "-Wall",
            f"-DFMI={version}",
            *defines,
            f"-I{headers}",
            f"-I{HERE}",
            str(HERE / f"{model}.c"),
            str(HERE / "wrapper.c"),
            "-o",
            str(library),
            "-lm",
        ],
        check=True,
    )
    return library


def write(path, entries):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)


def main():
    out, compiler, headers = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    out.mkdir(parents=True, exist_ok=True)

    def make(
        name,
        model,
        version,
        variables,
        indicators=0,
        defines=(),
        step="true",
        extra=None,
        xml=None,
        early="false",
        events="false",
    ):
        description = xml or (
            describe_2(variables, model, indicators, step)
            if version == 2
            else describe_3(variables, model, indicators, step, early, events)
        )
        library = compile_model(out, compiler, headers, model, version, list(defines))
        write(
            out / f"{name}.fmu",
            {
                "modelDescription.xml": description,
                f"binaries/{PLATFORM[version]}/{model}.so": library.read_bytes(),
                **(extra or {}),
            },
        )

    for version in (2, 3):
        make(f"two_beam_{version}", "two_beam", version, TWO_BEAM)
        make(f"bouncing_ball_{version}", "bouncing_ball", version, BALL, indicators=1)
        make(f"stairs_{version}", "stairs", version, STAIRS)
        make(f"feedthrough_{version}", "feedthrough", version, FEEDTHROUGH + (FEEDTHROUGH_3 if version == 3 else []))
        make(f"resource_{version}", "resource", version, RESOURCE, extra={"resources/value.txt": "97.5"})
        make(f"faulty_{version}", "faulty", version, FAULTY)
        make(
            f"wrong_token_{version}",
            "faulty",
            version,
            FAULTY,
            xml=(describe_2 if version == 2 else describe_3)(FAULTY, "faulty", 0, "true").replace(
                TOKEN[version], "{other}"
            ),
        )
    make("fixed_step", "two_beam", 2, TWO_BEAM, step="false")
    make("discards", "two_beam", 2, TWO_BEAM, defines=["-DLONGEST_STEP=0.004"])
    make("no_reset", "two_beam", 2, TWO_BEAM, defines=["-DNO_RESET"])
    make("early_return", "two_beam", 3, TWO_BEAM, defines=["-DEARLY_RETURN"], early="true")
    make("bouncing_ball_events", "bouncing_ball", 3, BALL, indicators=1, events="true")
    make("stairs_events", "stairs", 3, STAIRS, events="true")
    make("feedthrough_events", "feedthrough", 3, FEEDTHROUGH, events="true")
    clocked = describe_3(STAIRS, "stairs", 0, "true", events="true").replace(
        "</ModelVariables>",
        '<Clock name="clock" valueReference="950" causality="input" intervalVariability="constant"'
        ' intervalDecimal="1"/></ModelVariables>',
    )
    make("clocked", "stairs", 3, STAIRS, xml=clocked)
    for version in (2, 3):
        make(
            f"oscillator_{version}",
            "oscillator",
            version,
            OSCILLATOR,
            xml=offer_derivatives((describe_2 if version == 2 else describe_3)(OSCILLATOR, "oscillator", 0, "true")),
        )
    make(
        "oscillator_wrong",
        "oscillator",
        3,
        OSCILLATOR,
        defines=["-DWRONG_DERIVATIVE"],
        xml=offer_derivatives(describe_3(OSCILLATOR, "oscillator", 0, "true")),
    )
    make("oscillator_noisy", "oscillator", 3, OSCILLATOR, defines=["-DNOISY"])
    make("missing_function", "faulty", 2, FAULTY, defines=["-DNO_SET_REAL"])

    description = describe_2(FAULTY, "faulty", 0, "true")
    own_headers = {"model.h": (HERE / "model.h").read_text(), "faulty.c": (HERE / "faulty.c").read_text()}
    for version in (2, 3):
        sources = {f"sources/{name}": text for name, text in own_headers.items()}
        sources["sources/all.c"] = f"#define FMI {version}\n" + (HERE / "wrapper.c").read_text()
        sources[f"sources/wrapper_{version}.inc"] = (HERE / f"wrapper_{version}.inc").read_text()
        if version == 2:
            xml = description.replace(
                '<CoSimulation modelIdentifier="faulty" canHandleVariableCommunicationStepSize="true"/>',
                '<CoSimulation modelIdentifier="faulty" canHandleVariableCommunicationStepSize="true">'
                '<SourceFiles><File name="all.c"/><File name="faulty.c"/></SourceFiles></CoSimulation>',
            )
        else:
            xml = describe_3(FAULTY, "faulty", 0, "true")
            sources["sources/buildDescription.xml"] = (
                '<fmiBuildDescription fmiVersion="3.0"><BuildConfiguration modelIdentifier="faulty"><SourceFileSet language="C99">'
                '<SourceFile name="all.c"/><SourceFile name="faulty.c"/><PreprocessorDefinition name="UNUSED" value="1"/>'
                "</SourceFileSet></BuildConfiguration></fmiBuildDescription>"
            )
        write(out / f"source_{version}.fmu", {"modelDescription.xml": xml, **sources})
    write(out / "broken_source.fmu", {"modelDescription.xml": xml, **sources, "sources/faulty.c": "this is not C"})
    write(out / "other_platform.fmu", {"modelDescription.xml": description, "binaries/win64/faulty.dll": b"MZ"})
    write(out / "no_library.fmu", {"modelDescription.xml": description, "binaries/linux64/faulty.so": b"no library"})
    write(out / "no_description.fmu", {"binaries/linux64/faulty.so": b""})
    write(out / "fmi_1.fmu", {"modelDescription.xml": '<fmiModelDescription fmiVersion="1.0" guid="x"/>'})
    write(out / "broken_xml.fmu", {"modelDescription.xml": description[:300]})
    write(out / "traversal.fmu", {"modelDescription.xml": description, "resources/../../escaped.txt": "out"})
    write(out / "backslashes.fmu", {"modelDescription.xml": description, "resources\\..\\..\\escaped.txt": "out"})
    write(out / "absolute.fmu", {"modelDescription.xml": description, "/tmp/twinmap-escaped.txt": "out"})
    (out / "not_a_zip.fmu").write_text("this is not an archive")
    link = zipfile.ZipInfo("resources/link")
    link.create_system = 3
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(out / "link.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.writestr(link, "/tmp")


if __name__ == "__main__":
    main()
