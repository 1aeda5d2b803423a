#include "manual.hpp"

namespace tool {

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}

// ---- the manual page --------------------------------------------------------------------------------

// Escapes backslashes and dashes for troff, and a dot or a quote at the beginning of a line.
std::string troff(const std::string& text) {
    const std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string synopsis(const OptionUsage& argument) {
    const std::string name = argument.value + (argument.repeated ? "..." : "");
    return argument.required ? name : "[" + name + "]";
}

void add_option(std::string& page, const OptionUsage& option) {
    page += ".TP\n\\fB" + troff(joined(option.names, ", ")) + "\\fR";
    if (!option.value.empty()) page += " \\fI" + troff(option.value) + "\\fR";
    page += "\n" + troff(option.description) + (option.required ? " (required)" : "") +
            (option.default_value.empty() ? "" : " (default: " + troff(option.default_value) + ")") + ".\n";
}

// ---- completions ------------------------------------------------------------------------------------

std::vector<std::string> all_names(const std::vector<OptionUsage>& options) {
    std::vector<std::string> names;
    for (const OptionUsage& option : options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

std::vector<std::string> command_names(const Usage& usage) {
    std::vector<std::string> names;
    for (const CommandUsage& command : usage.commands) names.push_back(command.name);
    return names;
}

// Escapes text within single quotes of a shell.
std::string shell_quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

// Escapes brackets and colons, which end parts of a specification of zsh's _arguments.
std::string zsh_part(const std::string& text) {
    return replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":", "\\:");
}

// What _arguments completes after an option or for an argument.
std::string zsh_action(const OptionUsage& option) {
    return option.choices.empty() ? "_files" : "(" + joined(option.choices, " ") + ")";
}

} // namespace

std::string manual_page(const Usage& usage, const std::string& version) {
    std::string page = ".\\\" Made from the options of the program.\n.TH " + usage.name + " 1 \"\" \"" +
                       usage.name + " " + version + "\" \"User Commands\"\n.SH NAME\n" + usage.name +
                       " \\- " + troff(usage.description) + "\n.SH SYNOPSIS\n";
    for (const CommandUsage& command : usage.commands) {
        page += ".B " + usage.name + " " + command.name + "\n[\\fIOPTION\\fR...]";
        for (const OptionUsage& argument : command.arguments) page += " " + synopsis(argument);
        page += "\n.br\n";
    }
    page += ".SH OPTIONS\n";
    for (const OptionUsage& option : usage.options) add_option(page, option);
    page += ".SH COMMANDS\n";
    for (const CommandUsage& command : usage.commands) {
        page += ".SS " + usage.name + " " + command.name + "\n" + troff(command.description) + ".\n";
        for (const OptionUsage& argument : command.arguments) {
            page += ".TP\n\\fI" + troff(argument.value) + "\\fR\n" + troff(argument.description) + ".\n";
        }
        for (const OptionUsage& option : command.options) add_option(page, option);
        if (!command.examples.empty()) page += ".PP\n.nf\n" + troff(command.examples) + "\n.fi\n";
    }
    page += ".SH EXIT STATUS\n.TP\n0\nSuccess.\n.TP\n1\nBad input, or output that cannot be "
            "written.\n.TP\n2\nWrong "
            "usage.\n";
    return page;
}

std::string bash_completion(const Usage& usage) {
    std::string text = "# Completions of " + usage.name +
                       " for bash, made from its options.\n"
                       "_" +
                       usage.name +
                       "() {\n"
                       "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
                       "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
                       "        COMPREPLY=($(compgen -W '" +
                       joined(command_names(usage), " ") + " help " + joined(all_names(usage.options), " ") +
                       "' -- \"$word\"))\n"
                       "        return\n"
                       "    fi\n"
                       "    case ${COMP_WORDS[1]}:$before in\n"
                       "    help:*) words='" +
                       joined(command_names(usage), " ") + "' ;;\n";
    for (const CommandUsage& command : usage.commands)
        for (const OptionUsage& option : command.options)
            if (!option.choices.empty())
                for (const std::string& name : option.names)
                    text += "    " + command.name + ":" + name + ") words='" + joined(option.choices, " ") +
                            "' ;;\n";
    text += "    esac\n"
            "    if [ -z \"$words\" ]; then\n"
            "        case ${COMP_WORDS[1]} in\n";
    for (const CommandUsage& command : usage.commands) {
        std::vector<std::string> words = all_names(command.options);
        for (const OptionUsage& argument : command.arguments)
            words.insert(words.end(), argument.choices.begin(), argument.choices.end());
        text += "        " + command.name + ") words='" + joined(words, " ") + "' ;;\n";
    }
    // Without an answer bash completes file names.
    return text +
           "        esac\n"
           "    fi\n"
           "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
           "}\n"
           "complete -o bashdefault -o default -F _" +
           usage.name + " " + usage.name + "\n";
}

std::string zsh_completion(const Usage& usage) {
    std::string text = "#compdef " + usage.name + "\n# Made from the options of " + usage.name +
                       ".\nlocal -a commands\ncommands=(\n";
    for (const CommandUsage& command : usage.commands)
        text += "  " + shell_quoted(replaced(command.name + ":" + command.description, "\\", "\\\\")) + "\n";
    text += "  'help:Show the options of a command'\n)\nif (( CURRENT == 2 )); then\n  _describe command "
            "commands\n";
    for (const OptionUsage& option : usage.options)
        for (const std::string& name : option.names) text += "  compadd -- " + name + "\n";
    text += "  return\nfi\nlocal command=$words[2]\nshift words\n(( CURRENT-- ))\ncase $command in\n"
            "help) _describe command commands ;;\n";
    for (const CommandUsage& command : usage.commands) {
        text += command.name + ")\n  _arguments";
        for (const OptionUsage& option : command.options)
            for (const std::string& name : option.names)
                text += " \\\n    " + shell_quoted(name + "[" + zsh_part(option.description) + "]" +
                                                   (option.value.empty() ? ""
                                                                         : ":" + zsh_part(option.value) +
                                                                               ":" + zsh_action(option)));
        for (const OptionUsage& argument : command.arguments)
            text += " \\\n    " + shell_quoted((argument.repeated   ? "*:"
                                                : argument.required ? ":"
                                                                    : "::") +
                                               zsh_part(argument.value) + ":" + zsh_action(argument));
        text += "\n  ;;\n";
    }
    return text + "esac\n";
}

std::string fish_completion(const Usage& usage) {
    const std::string complete = "complete -c " + usage.name;
    std::string text = "# Completions of " + usage.name + " for fish, made from its options.\n";
    const auto add = [&](const std::string& when, const OptionUsage& option) {
        text += complete + " -n " + shell_quoted(when);
        for (const std::string& name : option.names)
            text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.value.empty()) text += " -r";
        if (!option.choices.empty()) text += " -f -a " + shell_quoted(joined(option.choices, " "));
        text += " -d " + shell_quoted(option.description) + "\n";
    };
    for (const OptionUsage& option : usage.options) add("__fish_use_subcommand", option);
    for (const CommandUsage& command : usage.commands) {
        text += complete + " -n __fish_use_subcommand -f -a " + command.name + " -d " +
                shell_quoted(command.description) + "\n";
        for (const OptionUsage& option : command.options)
            add("__fish_seen_subcommand_from " + command.name, option);
        for (const OptionUsage& argument : command.arguments)
            if (!argument.choices.empty())
                text += complete + " -n " + shell_quoted("__fish_seen_subcommand_from " + command.name) +
                        " -f -a " + shell_quoted(joined(argument.choices, " ")) + "\n";
    }
    return text + complete + " -n __fish_use_subcommand -f -a help -d 'Show the options of a command'\n" +
           complete + " -n '__fish_seen_subcommand_from help' -f -a " +
           shell_quoted(joined(command_names(usage), " ")) + "\n";
}

} // namespace tool
