#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// Bytes as letters (RFC 4648, with padding), as pages have them.
std::string encodeBase64(const std::vector<unsigned char>& bytes);

/// The bytes of such letters, until the first that is none of them.
std::string decodeBase64(const std::string& letters);

}  // namespace twinmap
