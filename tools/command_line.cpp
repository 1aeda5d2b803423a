#include "command_line.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>

namespace tool {

namespace {

int wrong_usage(const CLI::App& app, const char* words) {
    const auto chosen = app.get_subcommands();
    std::fprintf(stderr, "vox: %s\nRun 'vox %s--help' for the usage.\n", words,
                 chosen.empty() ? "" : (chosen.front()->get_name() + " ").c_str());
    return 2;
}

// The arguments as CLI11 needs them: in reverse order, and with -.5 as -0.5, because it takes -.5 for an
// option.
std::vector<std::string> arguments_of(int argc, char** argv) {
    std::vector<std::string> arguments(std::make_reverse_iterator(argv + argc),
                                       std::make_reverse_iterator(argv + std::min(argc, 1)));
    for (std::string& argument : arguments)
        if (argument.size() > 2 && argument.starts_with("-.") && argument[2] >= '0' && argument[2] <= '9')
            argument.insert(1, "0");
    return arguments;
}

} // namespace

// ---- options --------------------------------------------------------------------------------------

Option& Option::required() { return option_->required(), *this; }

Option& Option::count(int values) { return option_->expected(values), *this; }

Option& Option::shown_as(const std::string& value) { return option_->type_name(value), *this; }

Option& Option::needs(const Option& other) { return option_->needs(other.option_), *this; }

Option& Option::excludes(const Option& other) { return option_->excludes(other.option_), *this; }

Option& Option::number(bool (*accept)(double value), const std::string& words) {
    const auto check = [accept, words](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool whole = !text.empty() && *end == '\0';
        return whole && std::isfinite(value) && accept(value) ? std::string()
                                                              : "expected " + words + ", found " + text;
    };
    option_->check(CLI::Validator(check, ""));
    return *this;
}

Option& Option::finite() {
    return number([](double) { return true; }, "a finite number");
}
Option& Option::positive() {
    return number([](double value) { return value > 0; }, "a number above 0");
}
Option& Option::not_negative() {
    return number([](double value) { return value >= 0; }, "a number of at least 0");
}
Option& Option::fraction() {
    return number([](double value) { return value > 0 && value < 1; }, "a number between 0 and 1");
}

Option& Option::range(std::uint32_t least, std::uint32_t most) {
    return option_->check(CLI::Range(least, most)), *this;
}
Option& Option::range(std::uint64_t least, std::uint64_t most) {
    return option_->check(CLI::Range(least, most)), *this;
}

// ---- commands -------------------------------------------------------------------------------------

Option Command::option(const std::string& name, std::string& value, const std::string& description) {
    return Option(app_->add_option(name, value, description));
}
Option Command::option(const std::string& name, std::vector<std::string>& value,
                       const std::string& description) {
    return Option(app_->add_option(name, value, description));
}
Option Command::option(const std::string& name, double& value, const std::string& description) {
    return Option(app_->add_option(name, value, description));
}
Option Command::option(const std::string& name, std::vector<double>& value, const std::string& description) {
    return Option(app_->add_option(name, value, description));
}
Option Command::option(const std::string& name, std::uint32_t& value, const std::string& description) {
    return Option(app_->add_option(name, value, description));
}
Option Command::option(const std::string& name, std::uint64_t& value, const std::string& description) {
    return Option(app_->add_option(name, value, description));
}

Option Command::flag(const std::string& name, bool& value, const std::string& description) {
    return Option(app_->add_flag(name, value, description));
}

Option Command::choice_of(const std::string& name, const std::function<bool(const std::string&)>& choose,
                          const std::string& names, const std::string& description) {
    const auto check = [name, choose, names](const std::string& given) {
        if (!choose(given)) throw CLI::ValidationError(name, "expected " + names + ", found " + given);
    };
    return Option(app_->add_option_function<std::string>(name, check, description)->type_name(names));
}

void Command::runs(const std::function<void()>& function) { app_->callback(function); }

// ---- the program ----------------------------------------------------------------------------------

CommandLine::CommandLine(const std::string& name, const std::string& version, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {
    app_->set_version_flag("--version", version);
    app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::add(const std::string& name, const std::string& description) {
    return Command(app_->add_subcommand(name, description));
}

int CommandLine::run(int argc, char** argv) {
    try {
        app_->parse(arguments_of(argc, argv)); // also runs the command
        return 0;
    } catch (const CLI::Success& request) { // --help, --version
        app_->exit(request);
        return 0;
    } catch (const CLI::ParseError& error) {
        return wrong_usage(*app_, error.what());
    } catch (const WrongUsage& error) {
        return wrong_usage(*app_, error.what());
    }
}

} // namespace tool
