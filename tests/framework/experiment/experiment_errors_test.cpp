// Every kind of mistake in an experiment file gives one error that names its place, its value and the rule.
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

struct Mistake {
  std::string name;
  std::string override_text;
  std::vector<std::string> expected;  ///< parts of the message
};

class ExperimentErrors : public testing::TestWithParam<Mistake> {};

TEST_P(ExperimentErrors, AreNamed) {
  try {
    loadExperiment(kTable1, {GetParam().override_text});
    FAIL() << "accepted " << GetParam().override_text;
  } catch (const ExperimentError& error) {
    for (const std::string& part : GetParam().expected) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "'" << part << "' is not in: " << error.what();
    }
  }
}

TEST(ExperimentError, HasThePartsOfItsMessage) {
  try {
    readExperiment(parseExperimentTree("name: cart\nseed: -1\n", "cart.yaml"));
    FAIL() << "accepted";
  } catch (const ExperimentError& error) {
    const InputProblem* problem = error.getProblem();
    ASSERT_NE(problem, nullptr);
    EXPECT_EQ(std::string(error.what()),
              toString(problem->where) + ": '" + problem->value + "' " + problem->rule);
    EXPECT_EQ(problem->where.file, "cart.yaml");
    EXPECT_EQ(problem->where.line, 2);
    EXPECT_EQ(problem->where.key_path, "seed");
    EXPECT_EQ(problem->value, "-1");
  }
  EXPECT_EQ(ExperimentError("as one").getProblem(), nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    All, ExperimentErrors,
    testing::Values(
        Mistake{"UnknownKey",
                "noise.scal=1",
                {"noise.scal:", "'scal' is not a key here", "did you mean 'scale'?"}},
        Mistake{"RateInAnotherUnit",
                "system.states={w: {derivative: y_dot, unit: m/s}}",
                {"system.states.w.derivative", "y_dot", "does not come out in (m/s)/s"}},
        Mistake{"StateWhoseNameIsTaken",
                "system.states={theta: {derivative: y_dot}}",
                {"system.states.theta", "is taken"}},
        Mistake{"ExpressionOfALaterOne",
                "system.expressions={a: 2 * later, later: y}",
                {"system.expressions.a", "later"}},
        Mistake{"LugreWithoutABristle",
                "system.friction=[{coordinate: y, model: lugre, coulomb: 1}]",
                {"system.friction[0]", "must give 'bristle' with 'model: lugre'"}},
        Mistake{"RegularisedWithoutAnOnset",
                "system.friction=[{coordinate: y, model: regularised, coulomb: 1}]",
                {"system.friction[0]", "must give 'onset_speed'"}},
        Mistake{"FrictionOfALengthAgainstAnAngle",
                "system.friction=[{coordinate: y, against: theta, model: regularised, coulomb: 1, "
                "onset_speed: 1}]",
                {"system.friction[0].against", "theta", "is in rad, but 'y' in m"}},
        Mistake{
            "CoulombTwiceOnACoordinate",
            "system.friction=[{coordinate: y, model: coulomb, coulomb: 1}, {coordinate: y, model: coulomb, "
            "coulomb: 2}]",
            {"system.friction[1].coordinate", "y", "has friction with 'model: coulomb' already"}},
        Mistake{"StopNeitherElasticNorRigid",
                "system.stops=[{coordinate: y, below: 0}]",
                {"system.stops[0]", "must give either 'stiffness'"}},
        Mistake{
            "RigidStopWithAnExponent",
            "system.stops=[{coordinate: y, below: 0, restitution: 0.5, exponent: 1.5}]",
            {"system.stops[0]", "must not give 'exponent', 'dissipation' or 'damping' with 'restitution'"}},
        Mistake{"RestitutionWithAUnit",
                "system.stops=[{coordinate: y, below: 0, restitution: d_y}]",
                {"system.stops[0].restitution", "does not come out in 1"}},
        Mistake{"StopOfALengthAgainstAnAngle",
                "system.stops=[{coordinate: y, against: theta, below: 0, restitution: 0.5}]",
                {"system.stops[0].against", "theta", "a stop is between two lengths or two angles"}},
        Mistake{"StopAgainstItself",
                "system.stops=[{coordinate: y, against: y, below: 0, restitution: 0.5}]",
                {"system.stops[0].against", "y", "must be another one than 'coordinate'"}},
        Mistake{"BristleInAnotherUnit",
                "system.friction=[{coordinate: y, model: lugre, coulomb: 1, bristle: {stiffness: d_y}}]",
                {"system.friction[0].bristle.stiffness", "does not come out in N/m"}},
        Mistake{"ExpressionWithoutAUnit",
                "outputs.y={expression: 2 * y}",
                {"outputs.y", "must give the unit of the expression"}},
        Mistake{"ExpressionInAnotherUnit",
                "outputs.y={expression: y_ddot + theta_ddot, unit: m/s2}",
                {"outputs.y.expression",
                 "adds or compares quantities of different units: y_ddot in m/s2, theta_ddot in s-2"}},
        Mistake{"UnknownTopLevelKey", "nose=1", {"nose", "did you mean 'noise'?"}},
        Mistake{"MeasuredColumnOfNoOutput",
                "measurement.columns={thet: a}",
                {"measurement.columns.thet", "is not an output", "did you mean 'theta'?"}},
        Mistake{"MeasuredInAnotherDimension",
                "measurement.columns={y: 'a [s]'}",
                {"measurement.columns.y:", "'s'", "does not convert to m"}},
        Mistake{"MeasuredInNoUnit",
                "measurement.columns={y: 'a [pixels]'}",
                {"measurement.columns.y:", "'pixels'", "is not a unit"}},
        Mistake{"MeasuredColumnWithoutName",
                "measurement.columns={y: '[mm]'}",
                {"measurement.columns.y", "must name a column"}},
        Mistake{"TimeInAnotherDimension", "measurement.time='t [m]'", {"measurement.time", "convert to s"}},
        Mistake{"TestSamplesAutomatic",
                "design.test.samples=automatic",
                {"design", "must give the number of test samples"}},
        Mistake{"SamplesNeitherNumberNorAutomatic",
                "design.train.samples=many",
                {"design.train.samples", "'many'", "must be automatic or a whole number"}},
        Mistake{"TimeOfANumberOfSamples",
                "design.train.time=5",
                {"design.train", "must give time with 'samples: automatic' only"}},
        Mistake{"TimeTwice",
                "measurement={time: t, sample_rate: 100}",
                {"measurement:", "must give time or sample_rate, not both"}},
        Mistake{"NoSampleRate", "measurement.sample_rate=0", {"measurement.sample_rate", "above 0"}},
        Mistake{"MissingKey",
                "system.springs=[{coordinate: y}]",
                {"system.springs[0]", "needs the key 'stiffness'"}},
        Mistake{"MisspelledRequiredKey",
                "system.springs=[{coordinate: y, stifness: 1}]",
                {"system.springs[0].stifness", "did you mean 'stiffness'?"}},
        Mistake{
            "SymbolForRequiredKey",
            "system.springs=[{coordinate: y, k: 1}]",
            {"system.springs[0].k:", "'k' is not a key here; did you mean 'stiffness', which is missing?"}},
        Mistake{"SymbolForAnotherRequiredKey",
                "outputs.y={q: y}",
                {"outputs.y.q:", "'q' is not a key here", "known: coordinate"}},
        Mistake{"SymbolBesideAMissingDamping",
                "system.dampers=[{viscosity: 3, coordinate: y}]",
                {"system.dampers[0].viscosity:", "did you mean 'damping', which is missing?"}},
        Mistake{"DecimalComma",
                "parameters.k_y.bounds=[0,1, 5]",
                {"parameters.k_y.bounds:",
                 "'[0, 1, 5]' must be a list of 2 values, not of 3; decimals are "
                 "written with a point, as 0.1"}},
        Mistake{
            "TextForNumber", "noise.scale=loud", {"noise.scale", "'loud'", "must be a number, 0 or above"}},
        Mistake{"QuotedNumber", "noise.scale=\"2\"", {"noise.scale", "must be a number"}},
        Mistake{"NegativeNumber", "noise.stddev.y=-1", {"noise.stddev.y", "'-1'", "0 or above"}},
        Mistake{"ZeroDuration", "simulation.duration=0", {"simulation.duration", "above 0"}},
        Mistake{"NoSimulation", "simulation={}", {"simulation.duration", "must be given, above 0"}},
        Mistake{"NotANumber", "simulation.duration=.nan", {"simulation.duration", "'.nan'"}},
        Mistake{"Infinite", "noise.scale=.inf", {"noise.scale", "'.inf'"}},
        Mistake{"Octal", "design.train.samples=010", {"design.train.samples", "octal"}},
        Mistake{"FractionalCount", "design.train.samples=1.5", {"design.train.samples", "whole number"}},
        Mistake{"HugeCount", "design.train.samples=1e30", {"design.train.samples", "'1e30'"}},
        Mistake{"YesForTrue", "inverse_map.gp.linear_term=yes", {"'yes' must be true or false"}},
        Mistake{"ListForNumber", "noise.scale=[1, 2]", {"noise.scale", "'[1, 2]'"}},
        Mistake{"ParameterByItsNameAlone", "k_y=8", {"'k_y=8' names a parameter: write parameters.k_y=8"}},
        Mistake{"ConstantsInACircle",
                "constants.g.value=2 * g",
                {"constants.g.value", "uses 'g', which is declared only after it"}},
        Mistake{
            "TextForAnOutput", "outputs.y=q", {"outputs.y", "'q' must be a map, such as {coordinate: ...}"}},
        Mistake{"NothingForMap", "noise=", {"noise", "'nothing'", "must be a map"}},
        Mistake{"UnknownEnum",
                "inverse_map.gp.length_scales=per_feat",
                {"must be one of shared, per_output, per_feature", "did you mean 'per_feature'?"}},
        Mistake{"BoundsSwapped",
                "parameters.k_y.bounds=[15, 5]",
                {"parameters.k_y.bounds", "'[15, 5]'", "lower below"}},
        Mistake{
            "BoundsEqual", "parameters.k_y.bounds=[5, 5]", {"parameters.k_y.bounds", "lower below upper"}},
        Mistake{"BoundsOfThree",
                "parameters.k_y.bounds=[1, 2, 3]",
                {"parameters.k_y.bounds", "list of 2 values"}},
        Mistake{"BoundsContainZero",
                "parameters.k_y={bounds: [-1, 1], relative_to: value}",
                {"parameters.k_y", "an error relative to the value is undefined"}},
        Mistake{"UnknownUnit",
                "parameters.k_y.unit=Nm/quux",
                {"parameters.k_y.unit", "'Nm/quux'", "is not a unit"}},
        Mistake{"IncoherentUnit", "parameters.k_y.unit=N/mm", {"parameters.k_y.unit", "coherent SI"}},
        Mistake{"ContradictingUnit",
                "parameters.k_y.unit=kg",
                {"table1.yaml:35:34: system.springs[0].stiffness", "'k_y'",
                 "does not come out in N/m with the units stated: k_y in kg"}},
        Mistake{"NamedExpressionInAnotherUnit",
                "system.expressions={pull: k_y * theta, other: pull + y}",
                {"system.expressions.other", "different units: k_y in N/m, theta in 1, y in m"}},
        Mistake{"UnknownNameInExpression",
                "system.springs[0].stiffness=2*k_x",
                {"system.springs[0].stiffness", "unknown name 'k_x'", "did you mean 'k_y'?"}},
        Mistake{"CoordinateInMass",
                "system.bodies.beam1.mass=y",
                {"system.bodies.beam1.mass", "unknown name 'y'"}},
        Mistake{"LaterConstant",
                "constants.m1=y_COM",
                {"constants.m1", "uses 'y_COM', which is declared only after it"}},
        Mistake{"UnknownCoordinate",
                "system.springs[0].coordinate=thet",
                {"'thet' is not a coordinate", "'theta'"}},
        Mistake{"UnknownBody",
                "system.applied_forces[0].body=beam3",
                {"'beam3' is not a body", "did you mean 'beam"}},
        Mistake{"UnknownOutput",
                "features[0].samples.outputs=[y, phi]",
                {"features[0].samples.outputs[1]", "'phi'"}},
        Mistake{"RepeatedOutput", "features[0].samples.outputs=[y, y]", {"listed twice"}},
        Mistake{"ParentDeclaredLater", "system.bodies.beam1.joint.parent=beam2", {"declared before"}},
        Mistake{
            "WrongNumberOfCoordinates", "system.bodies.beam1.joint.type=planar", {"beam1", "3 coordinates"}},
        Mistake{"AxisOfPlanarJoint",
                "system.bodies.beam1.joint={type: planar, axis: [1, 0, 0], coordinates: [y, a, b]}",
                {"only slider, pin, screw and cylinder"}},
        Mistake{"ScrewWithoutPitch", "system.bodies.beam2.joint.type=screw", {"needs joint.pitch"}},
        Mistake{"SpringOnBallAngle",
                "system={bodies: {b: {mass: 1, joint: {type: ball, coordinates: [y, theta, c]}}}, springs: "
                "[{coordinate: theta, stiffness: 1}]}",
                {"system.springs[0].coordinate", "use a bushing"}},
        Mistake{"TakenName", "parameters.y={bounds: [1, 2]}", {"'y' is taken"}},
        Mistake{"TakenByNuisance", "nuisance.k_y={bounds: [-1, 1]}", {"nuisance.k_y", "'k_y' is taken"}},
        Mistake{"DerivedOfUnknown",
                "derived.w={value: k_z / m1}",
                {"derived.w", "uses the unknown name 'k_z'", "did you mean 'k_y'?"}},
        Mistake{"DerivedInAnotherUnit",
                "derived.w={value: k_y * d_y, unit: kg}",
                {"derived.w", "does not come out in kg"}},
        Mistake{"DerivedOfLater",
                "derived={a: {value: b * k_y}, b: {value: k_y}}",
                {"derived.a", "uses 'b', which is not derived before it"}},
        Mistake{"DerivedOfItself",
                "derived={a: {value: a + k_y}}",
                {"derived.a", "uses 'a', which is not derived before it"}},
        Mistake{"DerivedTakenName", "derived={k_y: {value: 2 * d_y}}", {"derived.k_y", "'k_y' is taken"}},
        Mistake{"DerivedNowhere",
                "derived={a: {value: sqrt(-k_y)}}",
                {"derived.a", "is not a finite number at the centre of the bounds"}},
        Mistake{"TakenByInput", "inputs.m1={bounds: [1, 2]}", {"constants.m1", "'m1' is taken"}},
        Mistake{"GainWithUnit", "outputs.y.gain=k_y", {"outputs.y.gain", "does not come out in 1"}},
        Mistake{"OffsetInAnotherUnit", "outputs.y.offset=k_y", {"outputs.y.offset", "come out in m"}},
        Mistake{"TableOfNothing",
                "excitation.F.tables=[{interpolation: cubic}]",
                {"excitation.F.tables[0]", "at least 2 times, or measured"}},
        Mistake{"MeasuredWithoutTimes",
                "excitation.F.tables=[{measured: {file: a.csv, column: V1}}]",
                {"excitation.F.tables[0].measured", "exactly one of time, sample_rate"}},
        Mistake{"MeasuredWithTimeAndRate",
                "excitation.F.tables=[{measured: {file: a.csv, column: V1, time: t, sample_rate: 9}}]",
                {"excitation.F.tables[0].measured", "exactly one of time, sample_rate"}},
        Mistake{"ReservedName", "constants.sin=1", {"'sin' is reserved"}},
        Mistake{"Assignment", "system.applied_forces[0].force[1]=F=3", {"must not assign"}},
        Mistake{"Syntax",
                "system.applied_forces[0].force[1]=F +* 3",
                {"system.applied_forces[0].force[1]", "not a valid"}},
        Mistake{"TwoOutputsInOne", "outputs.y={coordinate: y, speed: y}", {"outputs.y", "exactly one"}},
        Mistake{"NoiseMissing", "noise.stddev={y: 1}", {"outputs.theta", "has no noise"}},
        Mistake{"NoiseOfNothing", "noise.stddev.z=1", {"noise.stddev.z", "is not an output"}},
        Mistake{"CorrelationOfNothing",
                "noise.correlation={yy: {values: [1]}}",
                {"noise.correlation.yy", "is not an output", "did you mean 'y'?"}},
        Mistake{"CorrelationOfBothKinds",
                "noise.correlation={y: {values: [1], autoregression: [0.1]}}",
                {"noise.correlation.y", "exactly one of autoregression, values"}},
        Mistake{"AutocorrelationOfAnotherVariance",
                "noise.correlation={y: {values: [2, 1]}}",
                {"noise.correlation.y", "begin with 1"}},
        Mistake{"ImpossibleAutocorrelation",
                "noise.correlation={y: {values: [1, 0.6]}}",
                {"noise.correlation.y", "not positive definite"}},
        Mistake{"UnstableAutoregression",
                "noise.correlation={y: {autoregression: [0.5, 0.6]}}",
                {"noise.correlation.y", "not stationary"}},
        Mistake{"FeaturesOffTheGridOfTheNoise",
                "noise.correlation={y: {autoregression: [0.5], sample_time: 0.03}}",
                {"noise.correlation.y", "not multiples of sample_time apart"}},
        Mistake{"FeaturesBeyondTheEnd",
                "features[0].samples.count=101",
                {"features[0].samples", "simulation.duration is 5 s"}},
        Mistake{"TwoKindsOfFeature",
                "features[0].statistics={outputs: [y], window: {start: 0, interval: 1, count: 2}, "
                "quantities: [max]}",
                {"features[0]", "must give one kind of feature"}},
        Mistake{"StatisticsBeyondTheEnd",
                "features=[{statistics: {outputs: [y], window: {start: 0, interval: 0.1, count: 52}, "
                "quantities: [max]}}]",
                {"features[0].statistics", "t = 5.1 s", "simulation.duration is 5 s"}},
        Mistake{"StatisticsOfAnUnknownOutput",
                "features=[{statistics: {outputs: [thta], window: {start: 0, interval: 0.1, count: 5}, "
                "quantities: [max]}}]",
                {"features[0].statistics.outputs[0]", "did you mean 'theta'?"}},
        Mistake{"RepeatedStatistic",
                "features=[{statistics: {outputs: [y], window: {start: 0, interval: 0.1, count: 5}, "
                "quantities: [max, max]}}]",
                {"features[0].statistics", "quantities twice"}},
        Mistake{"WindowOfOneSample",
                "features=[{statistics: {outputs: [y], window: {start: 0, interval: 0.1, count: 1}, "
                "quantities: [max]}}]",
                {"features[0].statistics.window", "at least 2 samples"}},
        Mistake{"ExtremaOfAnUnknownOutput",
                "features=[{extrema: {output: z, window: {start: 0, interval: 0.1, count: 9}, peaks: 1}}]",
                {"features[0].extrema.output", "'z' is not an output"}},
        Mistake{"ExtremaBeyondTheEnd",
                "features=[{extrema: {output: y, window: {start: 0, interval: 1, count: 9}, peaks: 1}}]",
                {"features[0].extrema", "simulation.duration is 5 s"}},
        Mistake{"EvenParabola",
                "features=[{extrema: {output: y, window: {start: 0, interval: 0.1, count: 9}, peaks: 1, "
                "fit_samples: 4}}]",
                {"features[0].extrema", "odd fit_samples"}},
        Mistake{"BetweenTheLines",
                "features=[{spectrum: {outputs: [y], window: {start: 0, interval: 0.05, count: 100}, "
                "frequencies: [1, 1.1]}}]",
                {"features[0].spectrum.frequencies[1]", "'1.1' must be a line", "= 0.2 Hz below 10 Hz"}},
        Mistake{"BeyondHalfTheSampleRate",
                "features=[{spectrum: {outputs: [y], window: {start: 0, interval: 0.05, count: 100}, "
                "frequencies: [10]}}]",
                {"features[0].spectrum.frequencies[0]", "below 10 Hz"}},
        Mistake{"RepeatedLine",
                "features=[{spectrum: {outputs: [y], window: {start: 0, interval: 0.05, count: 100}, "
                "frequencies: [1, 2, 1]}}]",
                {"features[0].spectrum.frequencies[2]", "listed twice"}},
        Mistake{"FrequencyResponseToNothing",
                "features=[{frequency_response: {excitation: G, outputs: [y], window: {start: 0, interval: "
                "0.05, count: 100}, frequencies: [1]}}]",
                {"features[0].frequency_response.excitation", "'G' is not an excitation signal"}},
        Mistake{"ModesWithoutNoise", "features[0]={modes: {count: 2}}", {"noise.modes", "is needed"}},
        Mistake{"NoiseOfNoModes",
                "noise.modes={frequency: 1, damping_ratio: 1}",
                {"noise.modes", "no feature is made of modes"}},
        Mistake{"ModesOfNothing",
                "features[0]={modes: {count: 2, frequencies: false, damping_ratios: false}}",
                {"features[0].modes", "must have frequencies or damping_ratios"}},
        Mistake{"UnknownStep", "transform=[z_scor]", {"transform[0]", "did you mean 'z_score'?"}},
        Mistake{"RankWithoutNoise",
                "transform=[z_score, principal_components]",
                {"transform[1]", "follows whiten"}},
        Mistake{"RankNotDirectlyBehindWhiten",
                "transform=[whiten, z_score, principal_components]",
                {"transform[2]", "follows whiten"}},
        Mistake{"WhitenByStddevBehindComponents",
                "transform=[whiten, principal_components, whiten]",
                {"transform[2]", "'whiten: {by: covariance}'"}},
        Mistake{"WhitenByStddevBehindCovariance",
                "transform=[whiten: {by: covariance}, whiten]",
                {"transform[1]", "'whiten: {by: covariance}'"}},
        Mistake{"WhitenByAnythingElse",
                "transform=[whiten: {by: variance}]",
                {"transform[0].whiten.by", "did you mean 'covariance'?"}},
        Mistake{"RankIsNoNumber",
                "transform=[partial_least_squares: {components: many}]",
                {"transform[0].partial_least_squares.components", "'many'", "automatic or a whole number"}},
        Mistake{"WhitenBehindPartialLeastSquares",
                "transform=[partial_least_squares, whiten]",
                {"transform[1]", "'whiten: {by: covariance}'"}},
        Mistake{"SelectNothing", "transform=[select]", {"transform[0]", "must give one of features"}},
        Mistake{"SelectTwice",
                "transform=[select: {features: [a], fisher_information: {count: 2}}]",
                {"transform[0].select", "must give one of features"}},
        Mistake{"SelectNamesBehindAProjection",
                "transform=[whiten, principal_components, select: {features: [y(1 s)]}]",
                {"transform[2].select.features[0]", "'y(1 s)' is not a feature"}},
        Mistake{"TwoRanks",
                "transform=[whiten, principal_components: {components: 3, explained_variance: 0.9}]",
                {"not both"}},
        Mistake{"NoFeatures", "features=[]", {"features"}},
        Mistake{"OneTestSample", "design.test.samples=1", {"design", "at least 2"}},
        Mistake{"UnknownAxis", "report.over=[k_y, k_z]", {"report.over[1]", "did you mean 'k_y'?"}},
        Mistake{"NameIsAPath", "name=a/b", {"'a/b' names the run's folder"}},
        Mistake{"SpeedsAtEquilibrium", "initial.speeds={y: 1}", {"initial", "must not give speeds"}},
        Mistake{"MultisinePhases",
                "excitation.F={multisines: [{amplitude: 1, frequencies: [1, 2], phases: [0]}]}",
                {"excitation.F.multisines[0]", "as many phases"}},
        Mistake{"TableNotIncreasing",
                "excitation.F={tables: [{times: [0, 0], values: [1, 2]}]}",
                {"excitation.F.tables[0]", "strictly increasing"}},
        Mistake{"NotFinite", "constants.m1.value=1/0", {"constants.m1.value: '1/0' is not a finite number"}},
        Mistake{"NotFiniteForce",
                "system.applied_forces[0].force[1]=sqrt(-1)",
                {"system.applied_forces[0].force[1]: 'sqrt(-1)' is not a finite number"}},
        Mistake{"NotANumberOfParameters",
                "system.springs[0].stiffness=k_y / (k_y - 10)",
                {"system.springs[0].stiffness", "is not a finite number at the centre of the bounds"}},
        Mistake{"SeedThatADoubleRounds", "seed=9007199254740993", {"seed: '9007199254740993' must be"}},
        Mistake{"NoStep", "transform=[]", {"transform: '[]' must not be empty"}},
        Mistake{"NoAxis", "report.over=[]", {"report.over: '[]' must not be empty"}},
        Mistake{"NoPhase",
                "excitation.F={multisines: [{amplitude: 1, frequencies: [1], phases: []}]}",
                {"excitation.F.multisines[0].phases: '[]' must not be empty"}},
        Mistake{"ManySamplesOfFeatures",
                "features[0].samples={outputs: [y], start: 0, interval: 1e-9, count: 1000001}",
                {"count: '1000001' must be a whole number from 1 to 1000000"}},
        Mistake{"SamplesCloserThanTheirTimes",
                "features[0].samples.interval=1e-12",
                {"interval: '1e-12' must be a number, 1e-9 or above"}},
        Mistake{"ManyLags",
                "noise.correlation={y: {values: [1, 0.5], sample_time: 1e-9}}",
                {"noise.correlation.y", "more than 20000 times sample_time apart"}},
        Mistake{"MorePeaksThanSamples",
                "features[0]={extrema: {output: y, peaks: 9, window: {start: 0, interval: 1, count: 5}}}",
                {"must not ask for more peaks than the window has samples"}},
        Mistake{"ManyDraws", "evaluation.posterior={draws: 1e7}", {"draws: '1e7' must be a whole number"}},
        Mistake{"ToleranceOfNoUse", "simulation.relative_tolerance=1e-300", {"from 1e-13 to 0.1"}},
        Mistake{"LongerThanNeeded",
                "simulation.duration=1e12",
                {"simulation.duration: '1e+12' must be at most 100 times the 5 s that the features need"}},
        Mistake{"EndlessSamples", "simulation.max_wall_time=1e300", {"at most 86400"}},
        Mistake{"IndexOutOfRange", "system.springs[9].stiffness=1", {"[9] of a list with 2 items"}},
        Mistake{"MalformedPath", "system..springs=1", {"malformed key path"}},
        Mistake{"NoOverride", "noise.scale", {"is not an override"}}),
    [](const testing::TestParamInfo<Mistake>& mistake) { return mistake.param.name; });

TEST(ExperimentErrors, AnExcitationThatDependsOnAParameterHasNoFrequencyResponse) {
  const std::string feature =
      "features=[{frequency_response: {excitation: F, outputs: [y], window: {start: 0, interval: 0.05, "
      "count: "
      "100}, frequencies: [1]}}]";
  EXPECT_NO_THROW(loadExperiment(kTable1, {feature}));
  try {
    loadExperiment(kTable1, {feature, "constants.force=2 * k_y", "excitation.F.pulses[0].amplitude=force"});
    FAIL();
  } catch (const ExperimentError& error) {
    const std::string message = error.what();
    EXPECT_NE(
        message.find("excitation.F.pulses[0].amplitude: 'force' depends on the sampled parameter 'k_y'"),
        std::string::npos)
        << message;
  }
}

TEST(ExperimentErrors, NameTheKeyWhoseDefaultBreaksARule) {
  YamlNode root = loadExperimentTree(kTable1, {"noise.stddev.y=0"});
  root.entries.erase(std::find_if(root.entries.begin(), root.entries.end(),
                                  [](const YamlEntry& entry) { return entry.key == "transform"; }));
  try {
    readExperiment(root);
    FAIL();
  } catch (const ExperimentError& error) {
    EXPECT_EQ(std::string(error.what()), kTable1 + ": transform: 'whiten' needs noise above 0 on output 'y'");
  }
}

TEST(ExperimentErrors, NameFileLineAndColumn) {
  YamlNode root = parseYaml("name: x\nparameters:\n  a: {bounds: [2, 1]}\n", "some.yaml");
  try {
    readExperiment(root);
    FAIL();
  } catch (const ExperimentError& error) {
    EXPECT_STREQ(
        error.what(),
        "some.yaml:3:15: parameters.a.bounds: '[2, 1]' must be [lower, upper] with lower below upper");
  }
}

}  // namespace
}  // namespace twinmap
