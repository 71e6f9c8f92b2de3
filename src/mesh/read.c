#include "base/clock.h"
#include "base/own.h"
#include "mesh/stream.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char program[] = "auxshell-read-mesh";

const char* const ax_up_words[3] = {[AX_UP_FILE] = "file", [AX_UP_Y] = "y", [AX_UP_Z] = "z"};

ax_read_options ax_read_options_default(void)
{
    return (ax_read_options){.seconds = 120, .bytes = (size_t)6 << 30, .up = AX_UP_FILE};
}

// What is wrong before anybody looks inside. Opening would hang on a pipe, so the kind comes first.
static ax_status check_file(const char* path, ax_error* error)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return ax_fail(error, AX_BAD_INPUT, "%s cannot be read: %s. Check the name and the folder.", path,
                       strerror(errno));
    if (S_ISDIR(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is a folder. Name a mesh file, for example one inside it.", path);
    if (!S_ISREG(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is no ordinary file. Save the mesh to a file and name that.", path);
    if (info.st_size == 0)
        return ax_fail(error, AX_BAD_INPUT, "%s is empty (0 bytes). Export the mesh again.", path);
    if (access(path, R_OK) != 0)
        return ax_fail(error, AX_BAD_INPUT, "%s cannot be read: %s. Give yourself the right to read it.", path,
                       strerror(errno));
    return AX_OK;
}

typedef struct parser {
    pid_t process;
    int output, complaints; // our ends of its standard output and error
    double deadline;
    bool late;
    char words[1024]; // what it complained, cut to what fits
    size_t word_count;
} parser;

static ax_status start(parser* p, const char* path, const ax_read_options* options, ax_error* error)
{
    char executable[AX_OWN_PATH], bytes[32], seconds[32];
    if (!ax_own_path(program, AX_READER_BUILT, AX_READER_INSTALLED, executable))
        strcpy(executable, program); // in PATH, perhaps
    snprintf(bytes, sizeof bytes, "%zu", options->bytes);
    snprintf(seconds, sizeof seconds, "%.0f", options->seconds + 1);
    char* arguments[] = {executable, bytes, seconds, (char*)ax_up_words[options->up], (char*)path, NULL};

    int output[2], complaints[2];
    if (pipe2(output, O_CLOEXEC) != 0)
        return ax_fail(error, AX_FAILED, "No pipe could be opened: %s.", strerror(errno));
    if (pipe2(complaints, O_CLOEXEC) != 0) {
        int reason = errno;
        close(output[0]);
        close(output[1]);
        return ax_fail(error, AX_FAILED, "No pipe could be opened: %s.", strerror(reason));
    }
    fcntl(output[0], F_SETPIPE_SZ, 1 << 20); // fewer switches between the two; the default does too

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, complaints[1], STDERR_FILENO);
    int reason = posix_spawnp(&p->process, executable, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(output[1]);
    close(complaints[1]);
    if (reason != 0) {
        close(output[0]);
        close(complaints[0]);
        return ax_fail(error, AX_FAILED,
                       "%s, which reads mesh files, could not be started: %s. Build or install it again.", executable,
                       strerror(reason));
    }
    p->output = output[0];
    p->complaints = complaints[0];
    p->deadline = ax_seconds() + options->seconds;
    return AX_OK;
}

// Keeps the beginning and drains the rest, so that the parser never waits for a reader. False at the end.
static bool listen_to_complaints(parser* p)
{
    char rest[4096];
    size_t space = sizeof p->words - 1 - p->word_count;
    ssize_t got = read(p->complaints, space ? p->words + p->word_count : rest, space ? space : sizeof rest);
    if (got > 0 && space)
        p->word_count += (size_t)got;
    return got > 0 || (got < 0 && errno == EINTR);
}

// Waits until there is something on either pipe. False when the time is over.
static bool wait_for_parser(parser* p, bool* output, bool* complaints)
{
    for (;;) {
        double left = p->deadline - ax_seconds();
        if (!(left > 0)) {
            p->late = true;
            return false;
        }
        struct pollfd ends[2] = {{.fd = *output ? p->output : -1, .events = POLLIN},
                                 {.fd = *complaints ? p->complaints : -1, .events = POLLIN}};
        int ready = poll(ends, 2, left > 1e6 ? -1 : (int)(1000 * left) + 1);
        if (ready < 0 && errno != EINTR)
            return false;
        if (ready <= 0)
            continue;
        *output = ends[0].revents != 0;
        *complaints = ends[1].revents != 0;
        return true;
    }
}

static bool take(void* context, void* into, size_t bytes)
{
    parser* p = context;
    char* at = into;
    bool talking = true;
    while (bytes > 0) {
        bool output = true, complaints = talking;
        if (!wait_for_parser(p, &output, &complaints))
            return false;
        if (complaints)
            talking = listen_to_complaints(p);
        if (!output)
            continue;
        ssize_t got = read(p->output, at, bytes);
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        if (got > 0) {
            at += got;
            bytes -= (size_t)got;
        }
    }
    return true;
}

// Reaps the parser, which is of no more use once everything is here or the time is over, and returns how it ended (-1
// if nobody knows).
static int finish(parser* p, bool received)
{
    close(p->output); // so that one which still writes ends
    bool output = false, complaints = !received && !p->late;
    while (complaints && wait_for_parser(p, &output, &complaints))
        complaints = listen_to_complaints(p);
    close(p->complaints);
    if (received || p->late)
        kill(p->process, SIGKILL);
    int ended;
    pid_t reaped;
    do
        reaped = waitpid(p->process, &ended, 0);
    while (reaped < 0 && errno == EINTR);
    while (p->word_count && p->words[p->word_count - 1] == '\n')
        --p->word_count;
    for (size_t i = 0; i < p->word_count; ++i) // it may quote the file, which must not talk to the terminal
        if ((unsigned char)p->words[i] < ' ' || p->words[i] == 127)
            p->words[i] = ' ';
    p->words[p->word_count] = 0;
    return reaped == p->process ? ended : -1;
}

static ax_status explain(const parser* p, int ended, const char* path, const ax_read_options* options, ax_error* error)
{
    if (p->late || (ended != -1 && WIFSIGNALED(ended) && WTERMSIG(ended) == SIGXCPU))
        return ax_fail(
            error, AX_BAD_INPUT,
            "%s could not be read within %g seconds, so reading was stopped. Reduce the number of faces, or export "
            "the mesh again in another format.",
            path, options->seconds);
    if (ended != -1 && WIFEXITED(ended) && WEXITSTATUS(ended) == ax_reader_bad_input && p->word_count)
        return ax_fail(error, AX_BAD_INPUT, "%s: %s", path, p->words);
    if (ended != -1 && WIFSIGNALED(ended) && WTERMSIG(ended) == SIGINT)
        return ax_fail(error, AX_CANCELLED, "Reading %s was interrupted.", path);
    return ax_fail(
        error, AX_BAD_INPUT,
        "%s: the importer broke down over this file, or needs more than %.3g GB of memory. The file is damaged or "
        "too large: export the mesh again, as OBJ, STL, PLY or OFF.%s%s",
        path, (double)options->bytes / (1 << 30), p->word_count ? " It said: " : "", p->words);
}

static ax_status parse(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_vertex_order* order,
                       ax_error* error)
{
    parser p = {0};
    ax_status status = start(&p, path, options, error);
    if (status != AX_OK)
        return status;
    bool received = ax_stream_receive(take, &p, mesh, order);
    int ended = finish(&p, received);
    return received ? AX_OK : explain(&p, ended, path, options, error);
}

static ax_status read_faces(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_vertex_order* order,
                            ax_error* error)
{
    ax_read_options standard = ax_read_options_default();
    options = options ? options : &standard;
    assert(options->seconds > 0 && options->bytes > 0);
    *mesh = (ax_mesh){0};
    ax_status status = check_file(path, error);
    return status == AX_OK ? parse(path, options, mesh, order, error) : status;
}

ax_status ax_mesh_read(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_mesh_repairs* repairs,
                       ax_error* error)
{
    ax_vertex_order order;
    ax_status status = read_faces(path, options, mesh, &order, error);
    if (status != AX_OK)
        return status;
    ax_error inner;
    status = ax_surface_make(mesh, order, repairs, &inner);
    return status == AX_OK ? AX_OK : ax_fail(error, status, "%s: %s", path, inner.message);
}

// The parser is not trusted, see stream.h.
static bool is_sound(const ax_mesh* mesh)
{
    for (int c = 0; c < 3 * mesh->face_count; ++c) {
        int v = mesh->faces[c / 3][c % 3];
        if (v < 0 || v >= mesh->vertex_count)
            return false;
    }
    for (int k = 0; k < 3 * mesh->vertex_count; ++k)
        if (!(fabs(mesh->positions[k / 3][k % 3]) <= 1e60)) // squares stay finite
            return false;
    return true;
}

ax_status ax_mesh_read_faces(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_error* error)
{
    ax_vertex_order order;
    ax_status status = read_faces(path, options, mesh, &order, error);
    if (status != AX_OK)
        return status;
    if (mesh->face_count == 0)
        status = ax_fail(error, AX_BAD_INPUT, "%s holds no faces. Export surfaces or solids as triangles.", path);
    else if (!is_sound(mesh))
        status = ax_fail(error, AX_BAD_INPUT,
                         "%s has faces without corners, or corners that are at no finite place. Export the mesh again.",
                         path);
    if (status != AX_OK)
        ax_mesh_free(mesh);
    return status;
}
