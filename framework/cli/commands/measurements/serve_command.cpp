#include <chrono>
#include <future>
#include <optional>
#include <twinmap/build_info.hpp>

#include "framework/base/log/log.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/measurements/track_options.hpp"
#include "framework/cli/signals.hpp"
#include "framework/serve/live/twin_server.hpp"
#include "framework/serve/twin/mqtt_source.hpp"
#include "framework/serve/twin/track_service.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap::cli {
namespace {

serve::Access makeAccess(const ServeArguments& arguments, const serve::ListenAddress& address) {
  if (!arguments.token_file.empty()) {
    return {serve::readToken(arguments.token_file)};
  }
  if (!address.isLoopback()) {
    throw ExperimentError(
        "--listen: other machines can connect to " + address.address +
        ", and no token is asked of them\n  give --token-file FILE: openssl rand -hex 32 > FILE");
  }
  return {};
}

/// Until the server ends, which it is told to where a signal comes; nothing comes by MQTT any more then.
void wait(std::future<void> running, serve::TwinServer& server, std::optional<serve::MqttSource>& mqtt) {
  constexpr std::chrono::milliseconds kLook{50};  // nobody notices
  const StopFlags signals = catchSignals();
  while (running.wait_for(kLook) != std::future_status::ready) {
    if (signals.stop) {
      mqtt.reset();
      server.stop();
      break;
    }
  }
  running.get();
}

}  // namespace

void serve(const ServeArguments& arguments) {
  setThreads(arguments.threads);
  serve::ListenAddress address = serve::parseListenAddress(arguments.listen);
  const serve::Access access = makeAccess(arguments, address);
  const TwinSource source(arguments.run);
  serve::TrackService service(source, arguments.state, makeTrackOptions(arguments));
  serve::TwinServer server(service, address, serve::HttpLimits{}, access, kVersion);
  address.port = server.getPort();
  std::optional<serve::MqttSource> mqtt;
  if (!arguments.mqtt_host.empty()) {
    mqtt.emplace(serve::MqttOptions{arguments.mqtt_host, arguments.mqtt_topic},
                 [&server](serve::Read read, serve::Answered answered) {
                   server.submit(std::move(read), std::move(answered));
                 });
  }
  logInfo("serving " + serve::makeUrl(address) + ", state in " + arguments.state);
  wait(std::async(std::launch::async, [&server] { server.run(); }), server, mqtt);
}

}  // namespace twinmap::cli
