#include "framework/serve/twin/mqtt_source.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/base/json/json.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"

#ifdef TWINMAP_HAS_MQTT
#include <mosquitto.h>

#include <future>
#endif

namespace twinmap::serve {

#ifdef TWINMAP_HAS_MQTT

namespace {

constexpr int kUsualPort = 1883, kKeepAliveSeconds = 60, kAtLeastOnce = 1;
constexpr int kMostBytes = 64 << 20;  // as of a body

struct Broker {
  std::string host;
  int port = kUsualPort;
};

Broker parseBroker(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  double port = kUsualPort;
  if (colon != std::string::npos &&
      (!parseLiteral(text.substr(colon + 1), port) || port != std::floor(port) || port < 1 || port > 65535)) {
    throw ExperimentError("--mqtt: '" + text + "' has no port from 1 to 65535 after its colon");
  }
  return {text.substr(0, colon), static_cast<int>(port)};
}

std::string makeErrorText(const std::string& error) {
  return formatJson(Json{{"status", "error"}, {"error", error}}) + "\n";
}

}  // namespace

class MqttSource::Implementation {
 public:
  Implementation(const MqttOptions& options, Submit submit)
      : topic_(options.topic), submit_(std::move(submit)), client_(makeClient(options.topic)) {
    const Broker broker = parseBroker(options.host);
    mosquitto_connect_callback_set(client_.get(), &Implementation::subscribe);
    mosquitto_message_callback_set(client_.get(), &Implementation::take);
    mosquitto_user_data_set(client_.get(), this);
    const int failed = mosquitto_connect(client_.get(), broker.host.c_str(), broker.port, kKeepAliveSeconds);
    if (failed != MOSQ_ERR_SUCCESS) {
      throw std::runtime_error("--mqtt: " + options.host +
                               " cannot be reached: " + mosquitto_strerror(failed));
    }
    mosquitto_loop_start(client_.get());
  }

  ~Implementation() {
    mosquitto_disconnect(client_.get());
    mosquitto_loop_stop(client_.get(), false);
  }

 private:
  using Client = std::unique_ptr<mosquitto, void (*)(mosquitto*)>;

  /// The broker keeps what comes while a client of that name is away.
  static Client makeClient(const std::string& topic) {
    mosquitto_lib_init();
    if (mosquitto_sub_topic_check(topic.c_str()) != MOSQ_ERR_SUCCESS) {
      throw ExperimentError("--topic: '" + topic + "' is not a topic that can be subscribed to");
    }
    return {mosquitto_new(("twinmap:" + topic).c_str(), false, nullptr), &mosquitto_destroy};
  }

  static void subscribe(mosquitto* client, void* self, int refused) {
    const std::string& topic = static_cast<Implementation*>(self)->topic_;
    if (refused != 0) {
      logError("MQTT: the broker refuses: " + std::string(mosquitto_connack_string(refused)));
    } else {
      mosquitto_subscribe(client, nullptr, topic.c_str(), kAtLeastOnce);
      logInfo("MQTT: subscribed to " + topic);
    }
  }

  /// The message is acknowledged when this returns: its answer is on disk by then.
  static void take(mosquitto* client, void* self, const mosquitto_message* message) {
    const std::string answer_topic = std::string(message->topic) + "/answer";
    const std::string answer = static_cast<Implementation*>(self)->answer(*message);
    mosquitto_publish(client, nullptr, answer_topic.c_str(), static_cast<int>(answer.size()), answer.data(),
                      kAtLeastOnce, false);
  }

  std::string answer(const mosquitto_message& message) const {
    if (message.payloadlen > kMostBytes) {
      return makeErrorText("a message has at most 64 MiB");
    }
    try {
      std::string text(static_cast<const char*>(message.payload),
                       static_cast<std::size_t>(message.payloadlen));
      std::promise<Outcome> promise;
      submit_([&text] { return readPostedText(std::move(text)); },
              [&promise](Outcome outcome) { promise.set_value(std::move(outcome)); });
      const Outcome outcome = promise.get_future().get();
      return outcome.kind == Outcome::kAnswered ? outcome.text : makeErrorText(outcome.text);
    } catch (const std::exception& error) {
      return makeErrorText(error.what());
    }
  }

  const std::string topic_;
  const Submit submit_;
  const Client client_;
};

#else

class MqttSource::Implementation {
 public:
  Implementation(const MqttOptions&, const Submit&) {
    throw ExperimentError(
        "--mqtt: this twinmap was built without MQTT\n  install libmosquitto-dev and build again");
  }
};

#endif

MqttSource::MqttSource(const MqttOptions& options, Submit submit)
    : implementation_(std::make_unique<Implementation>(options, std::move(submit))) {}

MqttSource::~MqttSource() = default;

}  // namespace twinmap::serve
