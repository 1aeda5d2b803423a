// The command line: commands with options. Only command_line.cpp includes CLI11, which takes seconds to
// compile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace tool {

// Thrown by a command for wrong usage; exit code 2.
class WrongUsage : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A name that a user may give, and what it means. The first one of a list is the default.
template <class Value>
struct Choice {
    const char* name;
    Value value;
};

// An option or argument of a command. Other values than it accepts are wrong usage.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    Option& count(int values);                  // the number of values
    Option& each();                             // one value each time, any number of times
    Option& shown_as(const std::string& value); // in the usage
    Option& needs(const Option& other);
    Option& excludes(const Option& other);

    Option& finite();
    Option& not_zero();
    Option& positive();
    Option& not_negative();
    Option& fraction(); // between 0 and 1
    // A whole number. CLI11 by itself would read -1 as the largest one.
    Option& range(std::uint64_t least, std::uint64_t most);

private:
    friend class Command;
    // Accepts finite numbers for which `accept` is true; `words` describes them, e.g. "a number above 0".
    Option& number(bool (*accept)(double value), const std::string& words);

    CLI::Option* option_;
};

// One command. The variable of an option holds the default value, and must live until the command has run.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    // `name` is "--name" for an option, "NAME" for an argument.
    Option option(const std::string& name, std::string& value, const std::string& description);
    Option option(const std::string& name, std::vector<std::string>& value, const std::string& description);
    Option option(const std::string& name, double& value, const std::string& description);
    Option option(const std::string& name, std::vector<double>& value, const std::string& description);
    Option option(const std::string& name, std::uint32_t& value, const std::string& description);
    Option option(const std::string& name, std::uint64_t& value, const std::string& description);
    Option flag(const std::string& name, bool& value, const std::string& description);

    // The choices must live as long as the command.
    template <class Target, class Value, std::size_t count>
    Option choice(const std::string& name, Target& value, const Choice<Value> (&choices)[count],
                  const std::string& description) {
        std::vector<std::string> names;
        for (const Choice<Value>& choice : choices) names.push_back(choice.name);
        return choice_of(
            name, names, [&value, &choices](std::size_t i) { value = choices[i].value; }, description);
    }

    // Lines of the usage that show the command in use.
    void examples(const std::string& lines);
    void runs(const std::function<void()>& function);

private:
    Option option(const std::string& name, const std::string& type, const std::string& description,
                  const std::string& default_value,
                  const std::function<bool(const std::vector<std::string>&)>& take);
    Option choice_of(const std::string& name, const std::vector<std::string>& names,
                     const std::function<void(std::size_t)>& choose, const std::string& description);

    CLI::App* app_;
};

// An option or an argument in the usage.
struct OptionUsage {
    std::vector<std::string> names;         // "-o", "--output"; empty for an argument
    std::string value;                      // FLOAT, FILE, ...; the name of an argument; empty for a flag
    std::vector<std::string> choices;       // the accepted values, if they are a few words
    std::string description, default_value; // "": none
    bool required = false, repeated = false;
};

struct CommandUsage {
    std::string name, description, examples;
    std::vector<OptionUsage> arguments, options;
};

struct Usage {
    std::string name, description;
    std::vector<OptionUsage> options;
    std::vector<CommandUsage> commands;
};

// The program with its commands.
class CommandLine {
public:
    CommandLine(const std::string& name, const std::string& version, const std::string& description);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    Command add(const std::string& name, const std::string& description);

    // Runs the command that the arguments name. Returns the exit code: 0, or 2 after a message about wrong
    // usage.
    int run(int argc, char** argv);

    // The usage as data, for the manual page and the completions of shells.
    Usage usage() const;

private:
    std::unique_ptr<CLI::App> app_;
};

} // namespace tool
