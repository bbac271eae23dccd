#pragma once

#include <functional>
#include <memory>
#include <string>

#include "framework/serve/live/measurement_worker.hpp"

namespace twinmap::serve {

/// Where measurements come from by MQTT.
struct MqttOptions {
  std::string host;   ///< of the broker: NAME, NAME:PORT
  std::string topic;  ///< that measurements are published to; may have + and #
};

/// Subscribes to measurements, CSV or JSON, one a message. Quality of service 1: the broker sends one again
/// until it is on disk, also after this client was away. What it is answered is published to the topic
/// that it came by and "/answer". Connects again by itself.
class MqttSource {
 public:
  using Submit = std::function<void(Read, Answered)>;

  /// Throws ExperimentError for a host or topic that cannot be, or where twinmap was built without MQTT;
  /// std::runtime_error where the broker cannot be reached.
  MqttSource(const MqttOptions& options, Submit submit);
  MqttSource(const MqttSource&) = delete;
  MqttSource& operator=(const MqttSource&) = delete;
  /// Ends the connection; what was begun is answered before.
  ~MqttSource();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace twinmap::serve
