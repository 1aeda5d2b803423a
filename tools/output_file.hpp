// Files that commands write. What is wrong with a name is said before the work, not after it.
#pragma once

#include <initializer_list>
#include <string>

namespace tool {

// Whether the name ends with `ending` (".vtu"), in small or capital letters.
bool has_ending(const std::string& path, const char* ending);

// Throws Failure if a file cannot be written at `path`, or if its name has none of `endings`; an empty list:
// any name. Leaves a file that is there as it is.
void check_output(const std::string& path, std::initializer_list<const char*> endings = {});

// Replaces the file. Throws Failure.
void write_file(const std::string& path, const std::string& text);

} // namespace tool
