#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

/// Whose belief it is, and how measurements update it.
void addTwin(CLI::App& command, TwinArguments& arguments) {
  addArgument(command, "RUN", arguments.run, "Folder of a finished run, its maps.h5, or an experiment file");
  addOption(command, "--state", "FILE", arguments.state,
            "File of the belief: begun by the first measurement, replaced by each; the history is beside it")
      ->required();
  addOption(command, "--tracking", "FILE", arguments.tracking,
            "File with a section tracking (default: the experiment file)");
  addOption(command, "--use", "STATUS,...", arguments.use,
            "Let measurements of these statuses update that do not by themselves: model_mismatch, "
            "model_incomplete, missing_term, unreliable, not_simulated")
      ->delimiter(',')
      ->allow_extra_args(false);
  addOption(command, "--lag", "N", arguments.lag,
            "How many measurements back a late one may belong (default: 100)")
      ->check(CLI::Range(1, 10000));
  addKnown(command, arguments.known);
  addRefine(command, arguments.refine);
  addThreads(command, arguments.threads);
}

/// Where the measurements come from.
void addMeasurements(CLI::App& command, TrackArguments& arguments) {
  command.add_option("MEASUREMENT", arguments.files, "Files, as infer takes them")->option_text(" ");
  addOption(
      command, "--at", "TIME", arguments.at,
      "Time of the measurement: a date and time, or seconds since 1970 (default: by tracking.time, else "
      "its number)");
  addOption(command, "--start", "S", arguments.start, "Time in each file (s) at which the model's time is 0");
  addOption(
      command, "--windows", "S", arguments.windows,
      "Track the windows of each file that begin every S seconds, each a measurement whose time is that of "
      "its start in the file")
      ->check(makePositiveCheck());
  addOption(command, "--trial", "NAME", arguments.trial,
            "Which of the experiment's trials they record, where it has trials");
  addOption(command, "--folder", "DIR", arguments.folder,
            "Track the CSV and MATLAB files of a folder that are complete and were not tracked yet, in the "
            "order of the times that they state, else of their names");
  command.add_flag("--follow", arguments.follow,
                   "Go on with what comes: into the folder, until a signal, or without one CSV measurements "
                   "from the standard input, each ended by an empty line");
}

void addTrack(CLI::App& app) {
  const auto arguments = std::make_shared<TrackArguments>();
  CLI::App* command = app.add_subcommand("track", "Follow the parameters from one measurement to the next");
  command->footer(
      "Each measurement updates a belief that is kept in the state file, and prints a line of JSON: what "
      "infer says of it, and the belief behind it, with alarms where a parameter has changed. How parameters "
      "may move is the section tracking of the experiment file; without it all walk at unknown rates.");
  addTwin(*command, *arguments);
  addMeasurements(*command, *arguments);
  addOption(*command, "--history", "FILE", arguments->history,
            "File for all measurements so far (CSV): the belief then, and what all of them say of that time");
  addOption(*command, "--page", "FILE", arguments->page,
            "File for a page (HTML): the parameters over time, alarms, limits and forecast");
  command->callback([arguments] { track(*arguments); });
}

void addServe(CLI::App& app) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand("serve", "Answer measurements over HTTP, as they come");
  command->footer(
      "POST /measurements takes a measurement as CSV or JSON and answers as 'twinmap track' prints; what is "
      "answered is on disk. GET / is a page that updates itself, /state the belief, /history, /metrics and "
      "/health; /openapi.json describes them. SIGTERM finishes what was begun.");
  addTwin(*command, *arguments);
  addOption(*command, "--listen", "ADDRESS:PORT", arguments->listen,
            "Where to listen (default: 127.0.0.1:8765, this machine alone); port 0: any that is free");
  addOption(
      *command, "--token-file", "FILE", arguments->token_file,
      "File whose first line every request is to bring: 'Authorization: Bearer ...'; needed where other "
      "machines can connect");
  CLI::Option* topic = addOption(*command, "--topic", "TOPIC", arguments->mqtt_topic,
                                 "Topic of measurements by MQTT; answers go to TOPIC/answer");
  CLI::Option* host = addOption(*command, "--mqtt", "HOST", arguments->mqtt_host,
                                "Broker of MQTT that brings measurements too: HOST or HOST:PORT");
  host->needs(topic);
  topic->needs(host);
  command->callback([arguments] { serve(*arguments); });
}

}  // namespace

void addTwinCommands(CLI::App& app) {
  addTrack(app);
  addServe(app);
}

}  // namespace twinmap::cli
