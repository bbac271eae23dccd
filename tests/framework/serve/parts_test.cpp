#include <gtest/gtest.h>
#include <sys/stat.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/base/text/base64.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/serve/http/listen_address.hpp"
#include "framework/serve/live/access.hpp"
#include "framework/serve/live/posted_measurement.hpp"
#include "framework/serve/live/request_target.hpp"
#include "tests/framework/test_folder.hpp"

using namespace twinmap;
using namespace twinmap::serve;

namespace {

template <class Error, class Call>
std::string getMessage(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ListenAddress, IsAnAddressAndAPort) {
  EXPECT_EQ(parseListenAddress("0.0.0.0:80").address, "0.0.0.0");
  EXPECT_EQ(parseListenAddress("0.0.0.0:80").port, 80);
  EXPECT_EQ(parseListenAddress("[::]:8765").address, "::");
  EXPECT_EQ(parseListenAddress("localhost:0").address, "127.0.0.1");
  EXPECT_EQ(makeUrl(parseListenAddress("[::1]:8765")), "http://[::1]:8765");
  for (const char* wrong : {"", "8765", "host:1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:1.5",
                            "::1:8765", "[127.0.0.1]:1", "[]:1", "256.0.0.1:1"}) {
    EXPECT_NE(getMessage<ExperimentError>([&] { parseListenAddress(wrong); }).find("--listen: '"),
              std::string::npos)
        << wrong;
  }
}

TEST(ListenAddress, KnowsLoopback) {
  for (const char* own : {"127.0.0.1", "127.255.0.9", "::1"}) {
    EXPECT_TRUE((ListenAddress{own, 1}.isLoopback())) << own;
  }
  for (const char* other : {"0.0.0.0", "::", "128.0.0.1", "10.0.0.1", "::2", ""}) {
    EXPECT_FALSE((ListenAddress{other, 1}.isLoopback())) << other;
  }
}

TEST(RequestTarget, IsDecodedInItsQueryAlone) {
  const RequestTarget target =
      parseTarget("/a%20b?at=2026-11-26T10%3A00%3A00%2B01%3A00&name=a+b&empty=&bare");
  EXPECT_EQ(target.path, "/a%20b");
  EXPECT_EQ(target.query.at("at"), "2026-11-26T10:00:00+01:00");
  EXPECT_EQ(target.query.at("name"), "a b");
  EXPECT_EQ(target.query.at("empty"), "");
  EXPECT_EQ(target.query.at("bare"), "");
  for (const char* wrong : {"", "a", "http://a/", "/?a=%", "/?a=%1", "/?a=%1g", "/?a=1&a=1"}) {
    EXPECT_THROW(parseTarget(wrong), BadTarget) << wrong;
  }
}

TEST(PostedMeasurement, KeepsTheBitsOfNumbers) {
  const PostedMeasurement posted = readPostedJson(
      R"({"columns": {"t": [0, 0.1], "x [mm], \"a\"": [0.30000000000000004, null]}, "at": "now", "trial": "b"})");
  EXPECT_EQ(posted.text, "t,\"x [mm], \"\"a\"\"\"\n0,0.30000000000000004\n0.1,nan\n");
  EXPECT_EQ(posted.at, "now");
  EXPECT_EQ(posted.trial, "b");
}

TEST(PostedMeasurement, SaysWhichKeyBreaksWhichRule) {
  const std::pair<const char*, const char*> cases[] = {
      {"3", "'columns' is missing"},
      {R"({"columns": {}})", "'columns' must be an object with at least one column"},
      {R"({"columns": {"t": 3}})", "'columns.t' must be an array"},
      {R"({"columns": {"t": [1], "x": [1, 2]}})", "'columns.x' has 2 cells, and the first column 1"},
      {R"({"columns": {"t": [1], "x": ["1"]}})", "'columns.x[0]' must be a number or null"},
      {R"({"columns": {"t": [1]}, "at": true})", "'at' must be a text or a number"},
      {R"({"columns": {"t": [1]}, "when": 1})", "'when' is not known"}};
  for (const auto& [body, says] : cases) {
    const std::string message = getMessage<ExperimentError>([body = body] { readPostedJson(body); });
    EXPECT_NE(message.find(says), std::string::npos) << message;
  }
  EXPECT_THROW(readPostedJson("{\"columns\""), NotJson);
  EXPECT_THROW(readPostedJson(R"({"columns": {"t": [[1]]}})"), ExperimentError);
  EXPECT_THROW(readPostedJson(std::string(1 << 20, '[')), ExperimentError);
  EXPECT_EQ(readPostedJson(R"({"columns": {"t \"[{[{": [1]}})").text, "\"t \"\"[{[{\"\n1\n");
  EXPECT_THROW(readPostedJson(R"({"columns": {"t": [1e400]}})"), NotJson);
  EXPECT_EQ(readPostedText("t,x\n").text, "t,x\n");
  EXPECT_EQ(readPostedText(R"( {"columns": {"t": [1]}})").text, "t\n1\n");
}

TEST(Token, IsComparedWhole) {
  EXPECT_TRUE(equalsInConstantTime("secret", "secret"));
  for (const char* other : {"", "secre", "secrets", "Secret", "secretsecret"}) {
    EXPECT_FALSE(equalsInConstantTime(other, "secret")) << other;
  }
}

TEST(Token, IsTheFirstLineOfAFileThatOthersCannotRead) {
  const TestFolder folder;
  const std::string file = folder / "token";
  writeTextFile(file, "0123456789abcdef\nmore\n");
  ::chmod(file.c_str(), 0600);
  EXPECT_EQ(readToken(file), "0123456789abcdef");
  ::chmod(file.c_str(), 0644);
  EXPECT_NE(getMessage<ExperimentError>([&] { readToken(file); }).find("by all users"), std::string::npos);
  writeTextFile(file, "short\n");
  ::chmod(file.c_str(), 0600);
  EXPECT_NE(getMessage<ExperimentError>([&] { readToken(file); }).find("fewer than 16"), std::string::npos);
  EXPECT_NE(getMessage<ExperimentError>([&] { readToken(folder / "none"); }).find("--token-file"),
            std::string::npos);
}

TEST(Base64, IsReadAsItIsWritten) {
  for (const std::string text : {"", "a", "ab", "abc", "abcd", "\xff\xfe\x01"}) {
    EXPECT_EQ(decodeBase64(encodeBase64({text.begin(), text.end()})), text);
  }
}

}  // namespace
