#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

void addServe(CLI::App& app) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand("serve", "Answer measurements over HTTP, as they come");
  command->footer(
      "POST /measurements takes a measurement as CSV or JSON and answers as 'twinmap track' prints; what is "
      "answered is on disk. GET / is a page that updates itself, /state the belief, /history, /metrics and "
      "/health; /openapi.json describes them. SIGTERM finishes what was begun.");
  addArgument(*command, "RUN", arguments->run, "Folder of a finished run, or an experiment file");
  addOption(*command, "--state", "FILE", arguments->state, "File of the belief; made where it is not there")
      ->required();
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
  addOption(*command, "--tracking", "FILE", arguments->tracking,
            "File with a section 'tracking' (default: that of the experiment)");
  addOption(*command, "--use", "STATUS,...", arguments->use,
            "Statuses whose measurements update although they do not by themselves, such as model_mismatch")
      ->delimiter(',');
  addOption(*command, "--lag", "N", arguments->lag,
            "Measurements back that a late one may belong to (default: 100)")
      ->check(CLI::Range(1, 10000));
  addKnown(*command, arguments->known);
  addRefine(*command, arguments->refine);
  addThreads(*command, arguments->threads);
  command->callback([arguments] { serve(*arguments); });
}

}  // namespace

void addLiveCommands(CLI::App& app) {
  addServe(app);
}

}  // namespace twinmap::cli
