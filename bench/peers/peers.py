"""The peers: the script of each, its setting, its environment, and the cases of which it says nothing, with the reason."""
import dataclasses
from pathlib import Path

HERE = Path(__file__).resolve().parent
#: Machines of a case where one, or what is trained for all, takes long.
FEW = 10


@dataclasses.dataclass(frozen=True)
class Peer:
    name: str
    title: str
    script: str
    environment: str
    setting: str = ""
    #: At most so many of a case, and of those where one takes it more than ten seconds of a processor.
    machines: int = 40
    slow: tuple = ()
    #: Suffix of the model that it wants of each case in models/; "": twinmap's file.
    model: str = ""
    #: What of twinmap it is compared with.
    beside: str = "twinmap_infer"
    #: The cases that it is about, where these are not all.
    only: tuple = ()
    #: Case to reason, where more than the model is missing.
    cannot: dict = dataclasses.field(default_factory=dict)

    def find_model(self, kind):
        return HERE / "models" / f"{kind.name}{self.model}" if self.model else kind.file

    def count_machines(self, kind):
        return min(kind.machines, FEW if kind.name in self.slow else self.machines)

    def explain_lack(self, kind):
        """Why it is not asked about a case; "" where it is."""
        if self.only and kind.name not in self.only:
            return "not asked"
        if kind.name in self.cannot:
            return self.cannot[kind.name]
        return "" if self.find_model(kind).exists() else "no model of the case was written for it"


UNKNOWN = {"spikes": "a map is trained for a noise that is known"}
#: Cases of which sbi's networks are asked: their responses are smooth in the parameters.
ROUGH = {name: "asked about smooth cases alone" for name in ("servo_axis", "stick_slip")}
ARM = {
    "seven_joint_arm": "a map from some hundred simulations is for few parameters; these are 40, and 1000 simulations take 13 minutes"
}
PROFILES = {"seven_joint_arm": "40 profiles take days: a Jacobian is 160 simulations of 0.4 s"}
PEERS = [
    Peer("twinmap_infer", "twinmap, `infer FILE.yaml`", "twinmap_infer", "plain"),
    Peer(
        "twinmap_run",
        "twinmap, a run, then `infer RUN`",
        "twinmap_run",
        "plain",
        cannot={"seven_joint_arm": "the experiment says `inverse_map: none`", **UNKNOWN},
    ),
    Peer(
        "twinmap_map",
        "twinmap, a run, its map alone",
        "twinmap_run",
        "plain",
        setting="map",
        cannot={"seven_joint_arm": "the experiment says `inverse_map: none`", **UNKNOWN},
    ),
    Peer(
        "twinmap_diagnose",
        "twinmap, `diagnose`, then `infer corrected.yaml`",
        "twinmap_diagnose",
        "plain",
        only=("lacking_friction",),
    ),
    Peer("scipy_twinmap", "SciPy `least_squares` on twinmap's simulations", "scipy_twinmap", "plain"),
    Peer(
        "scipy_ivp",
        "SciPy `least_squares` on `solve_ivp`",
        "scipy_ivp",
        "plain",
        slow=("double_pendulum_mild", "servo_axis", "stick_slip"),
        model="_ode.py",
        cannot={"seven_joint_arm": "its equations of motion were not written by hand"},
    ),
    Peer(
        "mujoco",
        "MuJoCo 4.0 `sysid`",
        "mujoco_sysid",
        "plain",
        slow=("servo_axis", "stick_slip", "product"),
        model="_mujoco.py",
    ),
    Peer(
        "pypesto",
        "pyPESTO, profiles, on twinmap's simulations",
        "pypesto_profiles",
        "plain",
        machines=FEW,
        cannot=PROFILES,
    ),
    *[
        Peer(
            f"sbi_{count}",
            f"sbi, NPE on {count} of twinmap's simulations",
            "sbi_npe",
            "torch",
            setting=str(count),
            machines=FEW,
            beside="twinmap_map",
            cannot={**UNKNOWN, **ARM, **ROUGH},
        )
        for count in (500, 2000, 10000)
    ],
    Peer(
        "sklearn", "scikit-learn, a map alone", "sklearn_map", "plain", beside="twinmap_map", cannot={**UNKNOWN, **ARM}
    ),
    Peer(
        "figaroh",
        "FIGAROH, torque regression, with priors",
        "figaroh_arm",
        "figaroh",
        model="_figaroh.py",
        only=("seven_joint_arm",),
    ),
    Peer("gpytorch", "GPyTorch, a map alone", "gpytorch_map", "torch", beside="twinmap_map", cannot={**UNKNOWN, **ARM}),
]
