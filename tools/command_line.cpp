#include "command_line.hpp"

#include "terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>

namespace tool {

namespace {

int wrong_usage(const CLI::App& app, const char* words) {
    const auto chosen = app.get_subcommands();
    std::fprintf(stderr, "vox: %s\nRun 'vox %s--help' for the usage.\n", shown(words).c_str(),
                 chosen.empty() ? "" : (chosen.front()->get_name() + " ").c_str());
    return 2;
}

// The arguments for CLI11: in reverse order, and -.5 as -0.5, which it would mistake for an option.
std::vector<std::string> arguments_of(int argc, char** argv) {
    std::vector<std::string> arguments(std::make_reverse_iterator(argv + argc),
                                       std::make_reverse_iterator(argv + std::min(argc, 1)));
    for (std::string& argument : arguments)
        if (argument.size() > 2 && argument.starts_with("-.") && argument[2] >= '0' && argument[2] <= '9')
            argument.insert(1, "0");
    return arguments;
}

// How many letters to insert, delete, replace or swap with the next one to turn `a` into `b`.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> two_before(b.size() + 1), before(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) before[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], two_before[j - 2] + 1);
        }
        two_before = before;
        before = row;
    }
    return before.back();
}

// ", did you mean X?", or nothing if no name resembles the word.
std::string nearest(const std::string& word, const std::vector<std::string>& names) {
    const std::string* best = nullptr;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& name : names)
        if (const std::size_t found = distance(word, name); found < least) {
            best = &name;
            least = found;
        }
    return best ? ", did you mean '" + *best + "'?" : "";
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// `vox`, `vox help` and `vox help COMMAND`, equivalent to --help.
void replace_help(std::vector<std::string>& arguments) {
    if (arguments.empty()) arguments.push_back("--help");
    if (arguments.back() != "help") return;
    arguments.pop_back();
    arguments.insert(arguments.empty() ? arguments.end() : arguments.end() - 1, "--help");
}

// Names the first argument that CLI11 did not expect, and the name that it may mean.
std::string unexpected(const CLI::App& app) {
    const std::vector<std::string> rest = app.remaining(true);
    const auto chosen = app.get_subcommands();
    const std::string word = rest.front().substr(0, rest.front().find('='));
    const bool option = word.starts_with('-');
    return "unexpected " + std::string(option ? "option" : "argument") + " '" + word + "'" +
           (option ? nearest(word, option_names(chosen.empty() ? app : *chosen.front())) : "");
}

std::vector<std::string> split_choices(const std::string& text) {
    std::vector<std::string> parts;
    if (text.find('|') == std::string::npos) return parts;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find('|', begin)) != std::string::npos; begin = end + 1)
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

OptionUsage usage_of(const CLI::Option& option) {
    OptionUsage usage;
    for (const std::string& name : option.get_snames()) usage.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) usage.names.push_back("--" + name);
    const std::string type = option.get_type_name();
    if (option.get_positional())
        usage.value = option.get_name();
    else if (option.get_items_expected_max() > 0)
        usage.value = type;
    usage.choices = split_choices(type);
    usage.description = option.get_description();
    usage.default_value = option.get_default_str();
    usage.required = option.get_required();
    usage.repeated = option.get_positional() && option.get_items_expected_max() > 1;
    return usage;
}

} // namespace

// ---- options --------------------------------------------------------------------------------------

Option& Option::required() { return option_->required(), *this; }

Option& Option::count(int values) { return option_->expected(values), *this; }

Option& Option::each() { return option_->allow_extra_args(false), *this; }

Option& Option::shown_as(const std::string& value) { return option_->type_name(value), *this; }

Option& Option::needs(const Option& other) { return option_->needs(other.option_), *this; }

Option& Option::excludes(const Option& other) { return option_->excludes(other.option_), *this; }

namespace {

bool read(const std::string& text, double& value) {
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0';
}

template <class Number>
bool read(const std::string& text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::string words_of(double value) {
    char words[32];
    std::snprintf(words, sizeof words, "%.6g", value);
    return words;
}

} // namespace

Option& Option::number(bool (*accept)(double value), const std::string& words) {
    const auto check = [accept, words](const std::string& text) {
        double value = 0;
        return read(text, value) && std::isfinite(value) && accept(value)
                   ? std::string()
                   : "expected " + words + ", found " + text;
    };
    option_->check(CLI::Validator(check, ""));
    return *this;
}

Option& Option::finite() {
    return number([](double) { return true; }, "a finite number");
}
Option& Option::not_zero() {
    return number([](double value) { return value != 0; }, "a number other than 0");
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

Option& Option::range(std::uint64_t least, std::uint64_t most) {
    const auto check = [least, most](const std::string& text) {
        std::uint64_t value = 0;
        return read(text, value) && value >= least && value <= most
                   ? std::string()
                   : "expected a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
                         ", found " + text;
    };
    option_->check(CLI::Validator(check, ""));
    return *this;
}

// ---- commands -------------------------------------------------------------------------------------

Option Command::option(const std::string& name, std::string& value, const std::string& description) {
    const auto take = [&value](const std::vector<std::string>& given) {
        value = given.front();
        return true;
    };
    return option(name, "TEXT", description, value, take);
}
Option Command::option(const std::string& name, std::vector<std::string>& value,
                       const std::string& description) {
    const auto take = [&value](const std::vector<std::string>& given) {
        value = given;
        return true;
    };
    return option(name, "TEXT ...", description, "", take);
}
Option Command::option(const std::string& name, double& value, const std::string& description) {
    return option(name, "FLOAT", description, value == 0 ? "" : words_of(value),
                  [&value](const std::vector<std::string>& given) { return read(given.front(), value); });
}
Option Command::option(const std::string& name, std::vector<double>& value, const std::string& description) {
    const auto take = [&value](const std::vector<std::string>& given) {
        value.resize(given.size());
        for (std::size_t i = 0; i < given.size(); ++i)
            if (!read(given[i], value[i])) return false;
        return true;
    };
    std::string all;
    for (const double number : value) all += (all.empty() ? "" : " ") + words_of(number);
    return option(name, "FLOAT ...", description, all, take);
}
Option Command::option(const std::string& name, std::uint32_t& value, const std::string& description) {
    const auto take = [&value](const std::vector<std::string>& given) { return read(given.front(), value); };
    return option(name, "UINT", description, std::to_string(value), take).range(0, UINT32_MAX);
}
Option Command::option(const std::string& name, std::uint64_t& value, const std::string& description) {
    const auto take = [&value](const std::vector<std::string>& given) { return read(given.front(), value); };
    return option(name, "UINT", description, std::to_string(value), take).range(0, UINT64_MAX);
}

// CLI11's own options for the types above are templates that take seconds to compile.
Option Command::option(const std::string& name, const std::string& type, const std::string& description,
                       const std::string& default_value,
                       const std::function<bool(const std::vector<std::string>&)>& take) {
    CLI::Option* const added = app_->add_option(name, CLI::callback_t(take), description);
    const bool several = type.ends_with(" ...");
    added->type_name(several ? type.substr(0, type.size() - 4) : type);
    if (several) added->expected(CLI::detail::expected_max_vector_size);
    if (name.starts_with('-')) added->default_str(default_value);
    return Option(added);
}

Option Command::flag(const std::string& name, bool& value, const std::string& description) {
    return Option(app_->add_flag_callback(
        name, [&value] { value = true; }, description));
}

Option Command::choice_of(const std::string& name, const std::vector<std::string>& names,
                          const std::function<void(std::size_t)>& choose, const std::string& description) {
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : "|") + known;
    const auto take = [name, names, choose, all](const std::vector<std::string>& given) {
        const auto found = std::find(names.begin(), names.end(), given.front());
        if (found == names.end())
            throw CLI::ValidationError(name, "expected " + all + ", found " + given.front());
        choose(static_cast<std::size_t>(found - names.begin()));
        return true;
    };
    return option(name, all, description, names.front(), take);
}

void Command::examples(const std::string& lines) { app_->footer("Examples:\n" + lines); }

void Command::runs(const std::function<void()>& function) { app_->callback(function); }

// ---- the program ----------------------------------------------------------------------------------

CommandLine::CommandLine(const std::string& name, const std::string& version, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {
    app_->set_version_flag("--version", version);
    app_->require_subcommand(1);
    app_->footer("'vox help COMMAND' shows the options of a command.");
}

CommandLine::~CommandLine() = default;

Command CommandLine::add(const std::string& name, const std::string& description) {
    CLI::App* const command = app_->add_subcommand(name, description);
    // Options call their functions before the command runs.
    command->add_flag_callback("--progress", Progress::show_always,
                               "Show progress on standard error also if that is not a terminal");
    return Command(command);
}

int CommandLine::run(int argc, char** argv) {
    std::vector<std::string> arguments = arguments_of(argc, argv);
    replace_help(arguments);
    // An unknown command: CLI11 would only say that a command is missing.
    if (!arguments.empty() && !arguments.back().starts_with('-')) {
        const std::vector<std::string> names = command_names(*app_);
        if (std::find(names.begin(), names.end(), arguments.back()) == names.end())
            return wrong_usage(
                *app_, ("there is no command '" + arguments.back() + "'" + nearest(arguments.back(), names))
                           .c_str());
    }
    try {
        app_->parse(arguments); // also runs the command
        return 0;
    } catch (const CLI::Success& request) { // --help, --version
        app_->exit(request);
        return 0;
    } catch (const CLI::ParseError& error) {
        // A missing argument may be a misspelt one.
        const bool odd = error.get_exit_code() == int(CLI::ExitCodes::ExtrasError) ||
                         error.get_exit_code() == int(CLI::ExitCodes::RequiredError);
        return wrong_usage(*app_,
                           odd && !app_->remaining(true).empty() ? unexpected(*app_).c_str() : error.what());
    } catch (const WrongUsage& error) {
        return wrong_usage(*app_, error.what());
    }
}

Usage CommandLine::usage() const {
    Usage usage{app_->get_name(), app_->get_description(), {}, {}};
    for (const CLI::Option* option : app_->get_options()) usage.options.push_back(usage_of(*option));
    for (const CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; })) {
        CommandUsage& added = usage.commands.emplace_back(
            CommandUsage{command->get_name(), command->get_description(), command->get_footer(), {}, {}});
        for (const CLI::Option* option : command->get_options())
            (option->get_positional() ? added.arguments : added.options).push_back(usage_of(*option));
    }
    return usage;
}

} // namespace tool
