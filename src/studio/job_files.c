// Commands that read and write files: checking surfaces, uploads, exports, and opening documents.
#include "studio/describe.h"
#include "studio/draft.h"
#include "studio/hello.h"
#include "studio/job.h"

#include "ax/export.h"
#include "ax/picture.h"
#include "base/file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char* text_copy(const char* text)
{
    return ax_copy(text, strlen(text) + 1, 1);
}

// ---- surfaces -----------------------------------------------------------------------------------------------------------------

// Offers a picture for download; null if it could not be drawn.
static json_t* picture(desk* d, const ax_mesh* mesh, const ax_screen* screen, ax_screen_field field, const char* name)
{
    char *path = files_new_path(hub_files(d->hub), name), token[TOKEN_LENGTH + 1];
    json_t* url = NULL;
    if (ax_picture_screen(mesh, screen, field, 1200, 800, path, NULL) == AX_OK &&
        files_offer(hub_files(d->hub), path, name, token, NULL) == AX_OK)
        url = json_sprintf("file/%s", token);
    ax_free(path);
    return url ? url : json_null();
}

static void send_surface(desk* d, const job* j, const ax_mesh* mesh, const ax_screen* screen, const double origin[3])
{
    board b = {0};
    board_put_numbers(&b, SECTION_VERTICES, 3 * mesh->vertex_count, *mesh->positions, 3, origin);
    board_put_ints(&b, SECTION_FACES, 3 * mesh->face_count, *mesh->faces);
    board_put_numbers(&b, SECTION_VERTEX_CURVATURE, screen->vertex_count, screen->curvature, 1, NULL);
    if (screen->scale)
        board_put_numbers(&b, SECTION_VERTEX_SCALE, screen->vertex_count, screen->scale, 1, NULL);
    else
        board_clear(&b, SECTION_VERTEX_SCALE, SECTION_F32);
    size_t size;
    unsigned char* block = board_frame(&b, (frame_header){.kind = FRAME_SURFACE, .re = (unsigned)j->message.id}, 0,
                                       hub_before(d->hub), &size);
    board_free(&b);
    hub_send(d->hub, j->client, block, size, &d->cancel);
}

static ax_status check(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char *upload = NULL, *path = NULL, *unit = NULL;
    char *file = NULL, name[NAME_LENGTH + 1] = "";
    ax_target_options options = ax_target_options_default();
    ax_status status = message_unpack(&j->message, error, "{s?s, s?s, s?s, s?[F, F]}", "upload", &upload, "path", &path,
                                      "unit", &unit, "scale", &options.scale_lo, &options.scale_hi);
    if (status == AX_OK && !upload == !path)
        status = ax_fail(error, AX_USAGE, "check: name \"upload\" or \"path\".");
    if (status == AX_OK)
        status = upload ? files_upload(hub_files(d->hub), upload, &file, name, error)
                        : files_within(hub_files(d->hub), path, &file, error);
    if (status != AX_OK)
        return status;
    if (path)
        snprintf(name, sizeof name, "%s", strrchr(file, '/') + 1);
    ax_mesh mesh = {0};
    ax_mesh_repairs repairs = {0};
    ax_screen screen = {0};
    const ax_progress progress = desk_progress(d);
    status = ax_mesh_read(file, NULL, &mesh, &repairs, error);
    if (status == AX_OK)
        status = ax_target_screen(&mesh, &options, &progress, &screen, error);
    if (status == AX_OK) {
        double origin[3];
        for (int c = 0; c < 3; ++c)
            origin[c] = (screen.bounds[0][c] + screen.bounds[1][c]) / 2;
        send_surface(d, j, &mesh, &screen, origin);
        *result = describe_screen(name, &mesh, &repairs, &screen);
        json_object_set_new(*result, "origin", describe_point(origin));
        json_object_set_new(
            *result, "pictures",
            json_pack("{s:o, s:o}", "curvature", picture(d, &mesh, &screen, AX_SCREEN_CURVATURE, "curvature.png"),
                      "scale", screen.scale ? picture(d, &mesh, &screen, AX_SCREEN_SCALE, "scale.png") : json_null()));
    }
    ax_screen_free(&screen);
    ax_mesh_free(&mesh);
    ax_free(file);
    return status;
}

// ---- files --------------------------------------------------------------------------------------------------------------------

static ax_status copy_file(const char* from, const char* to, bool overwrite, ax_error* error)
{
    FILE* in = fopen(from, "rb");
    ax_file out;
    if (!in)
        return ax_fail(error, AX_FAILED, "%s cannot be read: %s.", from, strerror(errno));
    if (!overwrite && access(to, F_OK) == 0) {
        fclose(in);
        return ax_fail(error, AX_BAD_INPUT, "There is a file %s already. Choose another name, or overwrite it.",
                       strrchr(to, '/') + 1);
    }
    ax_status status = ax_file_begin(&out, to, error);
    if (status == AX_OK) {
        char block[1 << 16];
        size_t got;
        while ((got = fread(block, 1, sizeof block, in)) > 0)
            fwrite(block, 1, got, out.stream);
        status = ax_file_commit(&out, error);
    }
    fclose(in);
    return status;
}

static ax_status keep_upload(desk* d, const char* token, const char* name, ax_error* error)
{
    char *from, given[NAME_LENGTH + 1];
    ax_status status = files_upload(hub_files(d->hub), token, &from, given, error);
    if (status != AX_OK)
        return status;
    if (!name)
        name = given;
    size_t size = strlen(d->folder) + NAME_LENGTH + 2;
    char* to = ax_alloc(size, 1);
    if (files_name_is_plain(name)) {
        snprintf(to, size, "%s/%s", d->folder, name);
        status = copy_file(from, to, false, error);
    } else
        status = ax_fail(error, AX_BAD_INPUT, "\"%.100s\" is no plain file name.", name);
    ax_free(to);
    ax_free(from);
    return status;
}

static ax_status keep(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char *token, *name = NULL;
    char *path, given[NAME_LENGTH + 1];
    ax_status status = message_unpack(&j->message, error, "{s:s, s?s}", "upload", &token, "name", &name);
    if (status == AX_OK)
        status = files_upload(hub_files(d->hub), token, &path, given, error);
    if (status != AX_OK)
        return status;
    ax_free(path);
    status = keep_upload(d, token, name ? name : given, error);
    if (status == AX_OK)
        *result = json_pack("{s:s}", "name", name ? name : given);
    return status;
}

// The design that is written to files: exact if there is one.
static ax_status export(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char *ending, *word = NULL;
    ax_export_options options = {0};
    ax_status status = message_unpack(&j->message, error, "{s:s, s?s}", "ending", &ending, "state", &word);
    if (status != AX_OK)
        return status;
    for (int s = AX_STATE_FLAT; word && s <= AX_STATE_SIMULATED; ++s)
        if (strcmp(word, ax_state_name((ax_state)s)) == 0)
            options.state = (ax_state)s;
    if (word && options.state == AX_STATE_DEFAULT)
        return ax_fail(error, AX_USAGE, "export: \"state\" is flat, deployed or simulated.");
    const ax_design* design = session_exact(d->session);
    if (!design)
        return ax_fail(error, AX_CANNOT_REALISE, "The design is not exact yet: finish it, then export.");
    options.title = d->name;
    char name[NAME_LENGTH + 1], token[TOKEN_LENGTH + 1];
    snprintf(name, sizeof name, "%.80s%.16s", d->name, ending);
    if (!files_name_is_plain(name))
        return ax_fail(error, AX_USAGE, "export: \"ending\" is an ending such as \".svg\".");
    char* path = files_new_path(hub_files(d->hub), name);
    struct stat about;
    status = ax_export(design, path, &options, error);
    if (status == AX_OK && stat(path, &about) != 0)
        status = ax_fail(error, AX_FAILED, "The file cannot be read again: %s.", strerror(errno));
    if (status == AX_OK)
        status = files_offer(hub_files(d->hub), path, name, token, error);
    if (status == AX_OK)
        *result = json_pack("{s:[{s:s, s:o, s:I}]}", "files", "name", name, "url", json_sprintf("file/%s", token),
                            "bytes", (json_int_t)about.st_size);
    ax_free(path);
    return status;
}

// ---- opening ------------------------------------------------------------------------------------------------------------------

static char* folder_of(const char* path)
{
    const char* slash = strrchr(path, '/');
    char* folder = ax_copy(path, (size_t)(slash - path) + 1, 1);
    folder[slash == path ? 1 : slash - path] = 0;
    return folder;
}

// "roof" of "/a/b/roof.auxshell"
static char* name_of(const char* path)
{
    const char* slash = strrchr(path, '/');
    char* name = text_copy(slash ? slash + 1 : path);
    char* dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = 0;
    return name;
}

ax_status job_open(desk* d, ax_error* error)
{
    desk_source* from = &d->source;
    char *recipe_text = NULL, *draft = NULL, *file = NULL;
    ax_status status = AX_OK;
    if (from->path)
        file = text_copy(from->path);
    else if (from->draft)
        status = draft_path(from->draft, &file, error);
    else if (from->example) {
        file = hello_example_path(from->example);
        if (!file)
            status = ax_fail(error, AX_BAD_INPUT, "There is no example \"%.100s\".", from->example);
    } else
        status = draft_path(d->id, &draft, error);
    if (status == AX_OK) {
        d->folder = folder_of(file ? file : draft);
        d->name = from->name                    ? name_of(from->name)
                  : from->path || from->example ? name_of(file)
                                                : text_copy("Untitled");
        d->path = from->path && files_relative(hub_files(d->hub), from->path) ? text_copy(from->path) : NULL;
    }
    if (status == AX_OK && from->recipe) {
        json_t* whole =
            json_pack("{s:s, s:i, s:O}", "format", "auxshell-recipe", "version", 1, "operators", from->recipe);
        recipe_text = json_dumps(whole, JSON_COMPACT);
        json_decref(whole);
        const char* name;
        json_t* token;
        json_object_foreach(from->files, name, token) if (status == AX_OK) status =
            json_is_string(token) ? keep_upload(d, json_string_value(token), name, error)
                                  : ax_fail(error, AX_USAGE, "new: \"files\" names uploads by their tokens.");
    }
    const ax_progress progress = desk_progress(d);
    if (status == AX_OK)
        status = session_open(file, recipe_text, d->folder, &progress, &d->session, error);
    free(recipe_text);
    ax_free(draft);
    ax_free(file);
    return status;
}

const job_type job_types_files[] = {{"check", false, check}, {"keep", false, keep}, {"export", false, export}, {0}};
