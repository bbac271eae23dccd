#include "framework/c_api/guard.hpp"

namespace twinmap::c_api {
namespace {

thread_local std::string error_text;

}  // namespace

void setError(const char* text) noexcept {
  try {
    error_text = text;
  } catch (const std::exception&) {
    error_text.clear();  // no memory for the text either
  }
}

const char* getError() noexcept {
  return error_text.c_str();
}

void requireCount(std::size_t count, std::size_t expected, const char* what) {
  if (count != expected) {
    throw WrongArgument(std::string(what) + ": has room or values for " + std::to_string(count) +
                        ", must be " + std::to_string(expected));
  }
}

}  // namespace twinmap::c_api
