#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/results/gates.hpp"

namespace twinmap::cli {

/// What every command that reads an experiment takes.
struct ExperimentArguments {
  std::string file;
  std::vector<std::string> overrides;  ///< "key.path=value"
};

struct CheckArguments {
  ExperimentArguments experiment;
  std::string svg;    ///< picture of the mechanism; "": none
  bool full = false;  ///< long tables with all values
};

struct SimulateArguments {
  ExperimentArguments experiment;  ///< parameters.NAME=VALUE among the overrides sets the point
  std::string csv;                 ///< "": standard output
  bool noise = false;
};

struct RunArguments {
  ExperimentArguments experiment;
  std::string folder;  ///< "": results/NAME
  std::string store;   ///< "": chunks in the folder
  int threads = 1;
  double memory = 0.0;         ///< GiB that a sweep may take; 0: half of the machine's
  bool fail_fast = false;      ///< of a sweep: begin no case after one has failed
  bool quiet = false;          ///< no progress, only warnings
  bool features_only = false;  ///< simulate and write features.h5, train nothing
  std::string command_line;
  bool fail_on_gates = false;
};

struct SubmitArguments {
  RunArguments run;
  std::string on = "slurm";  ///< or "template", "local"
  int cpus = 1;              ///< threads of a job
  int minutes = 60;          ///< time limit of a job
  int shards = 0;            ///< that simulate; 0: by the cost of a sample
  std::string partition, account;
  std::vector<std::string> sbatch;  ///< further options of Slurm
  std::string submit, after;        ///< of a template
};

struct ShardArguments {
  std::string folder;
  int shard = 0;
  int threads = 1;
  std::string command_line;
};

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out;  ///< "": the run's folder; of several runs results/report
  bool fail_on_gates = false;
};

/// A gate failed and --fail-on-gates was given.
class GatesFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct StatusArguments {
  std::string folder;
  std::string store;  ///< "": the one that the run used
};

struct CompareArguments {
  std::string folder_a, folder_b;
  bool csv = false, json = false;  ///< at most one; neither: a human-readable table
};

struct NoiseArguments {
  std::string measurement;           ///< a file
  std::vector<double> window;        ///< s; [from, to], or empty: all
  std::vector<std::string> columns;  ///< or outputs of the experiment; empty: all
  std::string experiment;            ///< "": none
  bool json = false;
};

struct LookArguments {
  std::string measurement;   ///< a file
  std::string time;          ///< a column; "": t, time, or the first that increases
  double sample_rate = 0.0;  ///< Hz; 0: by the column
  bool json = false;
};

struct VerifyArguments {
  std::string folder;
  int samples = 5;
  std::uint64_t seed = 1;
  bool all = false;
  int threads = 1;
};

struct InferArguments {
  std::string run;                  ///< folder of a run, its maps.h5, or an experiment file
  std::vector<std::string> files;   ///< measurements
  std::vector<std::string> known;   ///< "NAME=VALUE" of the inputs
  std::vector<double> starts;       ///< times in each file that are 0 of the model; empty: the experiment's
  std::vector<std::string> trials;  ///< "NAME=FILE": recordings of trials, inferred together
  bool joint = false;               ///< all files and starts together
  std::optional<double> windows;    ///< s: windows of each file, one after another, inferred together
  std::optional<double> segments;   ///< s: each file cut into segments with initial states of their own
  bool json = false, csv = false;   ///< at most one; neither: a human-readable table
  bool follow = false;              ///< measurements from the standard input, JSON lines out
  std::optional<bool> refine;       ///< none: as the experiment says
  int posterior_draws = 0;          ///< of each measurement's posterior; 0: none
  std::string posterior_from;       ///< "simulator", "surrogate"; "": the simulator where that is fast
  std::string draws;                ///< file for them; "": none
  std::string profile;              ///< file for profile likelihoods; "": none
  std::string page;                 ///< file for the parameters over the measurements; "": none
  int threads = 0;                  ///< 0: all
  bool diagnose = false;            ///< of each model_mismatch, say at length what the model lacks
};

/// Of the commands that keep a twin in time.
struct TwinArguments {
  std::string run;               ///< folder of a run, its maps.h5, or an experiment file
  std::string state;             ///< file of the belief
  std::string tracking;          ///< file with a section `tracking:`; "": the experiment file's own
  std::vector<std::string> use;  ///< statuses of measurements that update although they do not by themselves
  std::vector<std::string> known;  ///< "NAME=VALUE" of the inputs
  std::optional<bool> refine;      ///< none: as the experiment says
  int lag = 100;                   ///< measurements back that a late one may belong to
  int threads = 0;                 ///< 0: all
};

struct TrackArguments : TwinArguments {
  std::vector<std::string> files;  ///< measurements, in any order within the lag
  std::string at;                  ///< time of the one measurement; "": by its table, else its number
  std::optional<double> start;     ///< as of infer
  std::optional<double> windows;   ///< s, between windows of each file; none: one a file
  std::string trial;               ///< that they record, of an experiment with trials
  std::string folder;              ///< whose files are tracked; "": none
  bool follow = false;             ///< as they come, into the folder or else on the standard input
  std::string history, page;       ///< files for track.csv and the page; "": none
};

struct ServeArguments : TwinArguments {
  std::string listen = "127.0.0.1:8765";
  std::string token_file;             ///< "": no token
  std::string mqtt_host, mqtt_topic;  ///< "": no MQTT
};

struct DiagnoseArguments {
  std::string run;                    ///< as of infer
  std::vector<std::string> files;     ///< measurements of one machine; empty: what a test is blind to
  std::vector<std::string> trials;    ///< "NAME=FILE" instead, of an experiment with trials
  std::vector<std::string> known;     ///< "NAME=VALUE" of the inputs
  std::vector<double> starts;         ///< times in each file that are 0 of the model; empty: the experiment's
  std::vector<std::string> accepted;  ///< terms to take; empty: those that are found
  std::vector<std::string> only, without;  ///< candidates that alone can be, and that cannot
  std::string out;                         ///< file for the corrected experiment; "": none
  std::string page;                        ///< file for the residuals and the unknown forces; "": none
  bool json = false, csv = false;          ///< at most one; neither: a human-readable table
  int threads = 0;                         ///< 0: all
};

struct ValidateArguments {
  std::string run;                   ///< as of infer
  std::vector<std::string> files;    ///< measurements of one machine, which its parameters are inferred from
  std::vector<std::string> against;  ///< those that are predicted
  std::vector<std::string> known;    ///< "NAME=VALUE" of the inputs
  std::vector<std::string> stated;   ///< the same of all parameters, in the place of an inference
  std::vector<double> starts;        ///< as of diagnose, in `files`
  std::vector<double> against_starts;  ///< in `against`
  std::optional<double> max_rms;  ///< of a prediction, in noise standard deviations; none: what noise allows
  bool json = false;
  int threads = 0;  ///< 0: all
};

struct SelectArguments {
  std::vector<std::string> files;  ///< experiment files, then measurements
  std::vector<std::string> known;  ///< "NAME=VALUE" of the inputs
  std::vector<double> starts;      ///< as of diagnose
  bool json = false;
  int threads = 0;  ///< 0: all
};

struct ExportArguments {
  std::string run;                 ///< folder of a run
  std::string c_folder;            ///< "": no C
  std::string fmu;                 ///< file; "": none
  int fmi = 3;                     ///< version of the FMU
  std::string json;                ///< file; "": none
  bool single = false;             ///< float instead of double
  std::string prefix = "twinmap";  ///< of names in C
  bool compressed = false;         ///< fewer inducing inputs, for at most 2 % of an sd
  bool trust = true;               ///< judge measurements
  bool track = false;              ///< a tracker beside, in C and the FMU
  std::string tracking;            ///< of it: a file with a section `tracking:`; "": none
};

/// Of a robot's file with an estimate's numbers.
struct RobotExportArguments {
  std::string estimate;            ///< JSON that infer wrote, or as of infer, with a measurement
  std::string measurement;         ///< "": `estimate` is JSON
  std::optional<double> start;     ///< as of infer
  std::vector<std::string> known;  ///< "NAME=VALUE" of the inputs
  std::string robot;               ///< its file, URDF or MJCF; "": no such export
  std::string out;                 ///< file to write; a JSON file beside it
  bool anyway = false;             ///< also of an estimate that is not ok
  int draws = 0;                   ///< files with numbers drawn from the estimate
  std::string draws_folder;
};

struct ImportArguments {
  std::string file;                     ///< URDF
  std::string base = "fixed";           ///< or "free"
  std::vector<std::string> parameters;  ///< inertia, friction, armature, damping
  std::vector<std::string> joints;      ///< that move; empty: all
  std::string csv;                      ///< table whose columns are called as coordinates; "": none
  bool from_motion = false;             ///< it is recorded, and the drives' forces are measured
  bool stops = false;                   ///< limits of joints become stops
  bool strict = false;                  ///< what is not carried over is an error
};

struct ViewArguments {
  ExperimentArguments experiment;  ///< or a run, without overrides
  std::string measurement;         ///< its updated model moves too; "": none
  std::optional<double> start;     ///< as of infer
  std::vector<std::string> known;  ///< "NAME=VALUE" of the inputs
  std::string out;                 ///< page; "": NAME.html, or none where a picture is asked for
  std::string svg;                 ///< picture; "": none
  std::string mp4;                 ///< film; "": none
};

struct ReplayArguments {
  std::string run;                   ///< folder of a run, or its maps.h5
  std::string file;                  ///< the measurement that is simulated again
  std::optional<double> start;       ///< time in the file that is 0 of the model; default: the experiment's
  std::string from;                  ///< the measurement that parameters are inferred from; "": the same
  std::optional<double> from_start;  ///< default: `start` of the same file, else the experiment's
  std::vector<std::string> known;    ///< "NAME=VALUE" of the inputs
  std::optional<bool> refine;        ///< none: as the experiment says
  int draws = 50;
  int threads = 1;
  std::string out;  ///< "": RUN/replay/STEM
};

struct DesignArguments {
  std::string what;  ///< "excitation", "sensors"
  ExperimentArguments experiment;
  std::string folder;   ///< "": results/NAME_design
  bool verify = false;  ///< train maps on both experiments and compare them
  int threads = 1;
  std::string command_line;
};

// One file a subcommand. Results go to stdout, progress and warnings to stderr. Each throws ExperimentError
// for wrong input and any other std::exception for a failure.

/// Validates an experiment, builds the model of each of its cases at the centre of the bounds, and
/// prints it with all defaults.
void check(const CheckArguments& arguments);

/// Prints the variables of an FMU: name, causality, variability, type, unit, start value, description.
void printVariables(const std::string& file);

struct ExplainArguments {
  std::string name;  ///< "": all
  bool json = false;
};

/// Prints what statuses and warnings say, their causes and remedies.
void explain(const ExplainArguments& arguments);

/// Prints the JSON schema of experiment files.
void printSchema();

/// Simulates once and writes a CSV: t, then each output by its name.
void simulate(const SimulateArguments& arguments);

/// Runs an experiment, or all cases of a sweep, and prints the table. Throws Interrupted where a signal asked
/// to stop, with the command that continues.
void run(const RunArguments& arguments);

/// Prints how far a sweep or a run is.
void status(const StatusArguments& arguments);

/// Print the models in a folder of simulated samples; the same after reading every byte of them. Throw
/// std::runtime_error if something is damaged.
void listStore(const std::string& folder);
void verifyStore(const std::string& folder);
/// Copies what other folders have into one. Throws std::runtime_error after all if some of it is damaged.
void mergeStore(const std::string& folder, const std::vector<std::string>& from);
/// Removes from a folder of simulated samples what no run needs.
void pruneStore(const std::string& folder);

/// Prints what run() would do with the same arguments, and does nothing of it.
void plan(const RunArguments& arguments);

/// Prints the shards that submit() would make.
void planShards(const SubmitArguments& arguments);

/// Submits what run() would do to a cluster, in shards, and prints the jobs, or the commands.
void submit(const SubmitArguments& arguments);

/// Does one shard of what was submitted.
void runShard(const ShardArguments& arguments);

/// Cancels the jobs of what was submitted in a folder.
void cancel(const std::string& folder);

/// What run() takes where the arguments leave it open: results/NAME, and half of the machine's memory
/// (bytes).
std::filesystem::path chooseFolder(const RunArguments& arguments, const ExperimentSpec& experiment);
double chooseMemory(const RunArguments& arguments);

/// What one case must not exceed, bytes: what is available, or more where the user says so.
double getMostMemory(const RunArguments& arguments);

/// Designs the excitation of an experiment and prints what it brings. Throws Interrupted where a signal asked
/// to stop, with the command that continues.
void designExcitation(const DesignArguments& arguments);

/// Chooses the outputs and sample times of an experiment and prints what each further one buys.
void designSensors(const DesignArguments& arguments);

/// Prints two runs side by side.
void compare(const CompareArguments& arguments);

/// Infers the parameters of measurements and prints them with their trust status. Throws std::runtime_error
/// after the last one if some could not be used.
void track(const TrackArguments& arguments);
void infer(const InferArguments& arguments);
/// Of several recordings together: where trials, windows or joint are given.
void inferJointly(const InferArguments& arguments);
void inferInSegments(const InferArguments& arguments);

/// Answers measurements over HTTP, and MQTT, until a signal comes.
void serve(const ServeArguments& arguments);

/// Says which terms a model lacks that is to explain measurements, and writes the corrected experiment; or,
/// without measurements, what they would not notice.
void diagnose(const DiagnoseArguments& arguments);

/// Predicts measurements by parameters inferred from others and prints how well. Throws GatesFailed where one
/// is predicted worse than noise and the parameters' covariance allow, or than by the nominal parameters.
void validate(const ValidateArguments& arguments);

/// Prints the evidence of several experiments for the same measurements, and how well each predicts those
/// that it is not fitted to.
void select(const SelectArguments& arguments);

/// Prints an experiment file that describes a robot, and what it leaves out on stderr. Throws ExperimentError
/// for a file that cannot be imported, with `strict` also where anything is left out.
void importRobot(const ImportArguments& arguments);

/// Writes a page on which the mechanism moves, or a picture of it.
void view(const ViewArguments& arguments);

/// Writes a robot's file with an estimate's numbers, all else as it is. Throws ExperimentError for an
/// estimate that is not ok, and parameters that fit nothing in the file.
void exportRobot(const RobotExportArguments& arguments);

/// Writes a trained map for other programs. Throws ExperimentError for a run that cannot be exported.
void exportMap(const ExportArguments& arguments);

/// Infers the parameters of a measurement, simulates the updated model next to it (the same measurement or
/// another), writes the comparison and prints how well it fits. Throws std::runtime_error for a measurement
/// that cannot be used and a simulation that fails.
void replay(const ReplayArguments& arguments);

/// Writes the report of runs, or of a sweep, again.
void report(const ReportArguments& arguments);

/// Prints the gates that failed; throws GatesFailed if there are any and `fail` is set.
void requireGates(const std::vector<GateResult>& gates, bool fail);

/// Prints the noise of a measurement's columns.
void noise(const NoiseArguments& arguments);

/// Prints what the columns of a measurement look like (look).
void look(const LookArguments& arguments);

/// Recomputes a part of a run, or all of it, and prints what differs; throws std::runtime_error if anything
/// does.
void verify(const VerifyArguments& arguments);

}  // namespace twinmap::cli
