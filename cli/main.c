// auxshell: dispatch to the subcommands in commands/, errors and exit codes.
#include "options.h"
#include "progress.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char* current = ""; // the subcommand, with the space before it

static void print_help(FILE* out)
{
    int count;
    const command* const* all = commands(&count);
    fputs(
        "usage: auxshell COMMAND ...\n\n"
        "Designs deployable auxetic shells: flat sheets of rigid triangles that open into a doubly curved surface.\n\n",
        out);
    for (int k = 0; k < count; ++k)
        fprintf(out, "  %-12s%s\n", all[k]->name, all[k]->summary);
    fputs("\n"
          "auxshell COMMAND --help explains a command, auxshell --version tells the version.\n"
          "Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 the design cannot be realised, 130 cancelled, 1 anything "
          "else.\n",
          out);
}

static void print_reference(FILE* out)
{
    int count;
    const command* const* all = commands(&count);
    fputs("# Command reference\n\n"
          "Written by `auxshell --reference`. Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 the design cannot be\n"
          "realised, 130 cancelled, 1 anything else. Results go to stdout, errors and progress to stderr. Options may "
          "be\n"
          "written `--option value` or `--option=value`, before or after the names.\n",
          out);
    for (int k = 0; k < count; ++k) {
        putc('\n', out);
        command_print_reference(all[k], out);
    }
}

static const command* find_command(const char* name, ax_error* error)
{
    int count;
    const command* const* all = commands(&count);
    const char** names = AX_NEW(const char*, count);
    const command* found = NULL;
    for (int k = 0; k < count; ++k) {
        names[k] = all[k]->name;
        if (strcmp(name, all[k]->name) == 0)
            found = all[k];
    }
    const char* nearest = ax_nearest_word(name, count, names);
    if (!found && nearest)
        ax_fail(error, AX_USAGE, "There is no command \"%s\". Did you mean \"%s\"?", name, nearest);
    else if (!found)
        ax_fail(error, AX_USAGE, "There is no command \"%s\". \"auxshell --help\" lists them all.", name);
    ax_free(names);
    return found;
}

static ax_status run(const command* c, int count, char** words, ax_error* error)
{
    void* arguments = ax_alloc(c->size, 1);
    ax_status status = command_parse(c, count, words, arguments, error);
    if (status == AX_OK)
        status = c->run(arguments, error);
    ax_free(arguments);
    return status;
}

static void out_of_memory(size_t bytes)
{
    fprintf(stderr, "auxshell%s: %zu more bytes of memory could not be had.\n", current, bytes);
    _exit(AX_FAILED);
}

// A result that could not be written is no result: a full disk behind stdout must not end in exit code 0.
static ax_status finish(ax_status status, ax_error* error)
{
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == AX_OK)
        status = ax_fail(error, AX_FAILED, "The result could not be written to standard output.");
    if (status != AX_OK && progress_cancelled())
        status = ax_fail(error, AX_CANCELLED, "Cancelled. Nothing was written.");
    progress_end();
    if (status != AX_OK && *error->message) // without one, the answer itself is the refusal: `check`
        fprintf(stderr, "auxshell%s: %s\n", current, error->message);
    return status;
}

int main(int count, char** words)
{
    ax_error error = {0};
    ax_set_out_of_memory(out_of_memory);
    signal(SIGXFSZ, SIG_IGN); // a file that may not grow fails like a full disk, with a message
    if (count < 2 || strcmp(words[1], "--help") == 0 || strcmp(words[1], "-h") == 0) {
        print_help(stdout);
        return finish(AX_OK, &error);
    }
    if (strcmp(words[1], "--version") == 0) {
        printf("auxshell %s\n", ax_version());
        return finish(AX_OK, &error);
    }
    if (strcmp(words[1], "--reference") == 0) {
        print_reference(stdout);
        return finish(AX_OK, &error);
    }
    const command* c = find_command(words[1], &error);
    if (!c)
        return finish(AX_USAGE, &error);
    static char name[64];
    snprintf(name, sizeof name, " %s", c->name);
    current = name;
    if (command_wants_help(count - 2, words + 2)) {
        command_print_help(c, stdout);
        return finish(AX_OK, &error);
    }
    progress_install(c->name);
    return finish(run(c, count - 2, words + 2, &error), &error);
}
