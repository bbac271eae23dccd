#pragma once

#include <exception>
#include <string>

#include "framework/base/text/source_location.hpp"
#include "framework/c_api/twinmap.h"

namespace twinmap::c_api {

/// An argument that cannot be.
class WrongArgument : public ExperimentError {
 public:
  using ExperimentError::ExperimentError;
};

/// What twinmap_get_error() gives to this thread; never throws.
void setError(const char* text) noexcept;
const char* getError() noexcept;

/// Throws WrongArgument, naming `what`, for a null pointer.
template <class Value>
Value& require(Value* pointer, const char* what) {
  if (pointer == nullptr) {
    throw WrongArgument(std::string(what) + ": must not be NULL");
  }
  return *pointer;
}

/// Throws WrongArgument where a caller's array has another length than what it is for.
void requireCount(std::size_t count, std::size_t expected, const char* what);

/// The border that no exception crosses: does `work`, or sets the error's text.
template <class Work>
twinmap_result guard(const Work& work) noexcept {
  try {
    work();
    return TWINMAP_OK;
  } catch (const ExperimentError& error) {
    setError(error.what());
    return TWINMAP_WRONG_INPUT;
  } catch (const std::exception& error) {
    setError(error.what());
  } catch (...) {
    setError("an unknown failure");
  }
  return TWINMAP_FAILED;
}

}  // namespace twinmap::c_api
