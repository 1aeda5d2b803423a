// Files that commands write. Bad names are reported before the work, not after it.
#pragma once

#include <initializer_list>
#include <string>

namespace tool {

// Whether the name ends with `ending` (".vtu"), in small or capital letters.
bool has_ending(const std::string& path, const char* ending);

// Throws Failure if a file cannot be written at `path`, or if its name has none of `endings`, unless the list
// is empty. Does not change an existing file.
void check_output(const std::string& path, std::initializer_list<const char*> endings = {});

// Replaces the file. Throws Failure.
void write_file(const std::string& path, const std::string& text);

} // namespace tool
