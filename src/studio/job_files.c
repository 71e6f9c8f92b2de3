// Commands that read and write files: checking surfaces, uploads, exports, and opening documents.
#include "studio/describe.h"
#include "studio/draft.h"
#include "studio/hello.h"
#include "studio/job.h"

#include "ax/export.h"
#include "ax/picture.h"
#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

// An upload has a name for people, and a place that is none of theirs.
static void call_by_name(ax_error* error, const char* path, const char* name)
{
    char* at = error ? strstr(error->message, path) : NULL;
    size_t length = strlen(path), room = strlen(name);
    if (!at || room > length)
        return;
    memcpy(at, name, room);
    memmove(at + room, at + length, strlen(at + length) + 1);
}

static ax_status check(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char *upload = NULL, *path = NULL, *unit = "m", *up = ax_up_words[AX_UP_FILE];
    char *file = NULL, name[NAME_LENGTH + 1] = "";
    ax_target_options options = ax_target_options_default();
    ax_status status = message_unpack(&j->message, error, "{s?s, s?s, s?s, s?s, s?[F, F]}", "upload", &upload, "path",
                                      &path, "unit", &unit, "up", &up, "scale", &options.scale_lo, &options.scale_hi);
    ax_read_options read = ax_read_options_default();
    ax_unit document_unit = AX_METRE;
    if (status == AX_OK && !upload == !path)
        status = ax_fail(error, AX_USAGE, "check: name \"upload\" or \"path\".");
    if (status == AX_OK && !ax_unit_parse(unit, &document_unit))
        status = ax_fail(error, AX_USAGE, "check: \"unit\" must be mm, cm or m.");
    while (status == AX_OK && strcmp(up, ax_up_words[read.up]) != 0)
        if (++read.up > AX_UP_Z)
            return ax_fail(error, AX_USAGE, "check: \"up\" must be file, y or z.");
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
    status = ax_mesh_read(file, &read, &mesh, &repairs, error);
    if (status == AX_OK)
        status = ax_target_screen(&mesh, &options, &progress, &screen, error);
    if (status == AX_OK) {
        double origin[3];
        for (int c = 0; c < 3; ++c)
            origin[c] = (screen.bounds[0][c] + screen.bounds[1][c]) / 2;
        send_surface(d, j, &mesh, &screen, origin);
        *result = describe_screen(name, &mesh, &repairs, &screen);
        json_object_set_new(*result, "origin", describe_point(origin));
        json_object_set_new(*result, "likely_unit",
                            json_string(ax_unit_name(ax_unit_likely(screen.diagonal, document_unit))));
        json_object_set_new(
            *result, "pictures",
            json_pack("{s:o, s:o}", "curvature", picture(d, &mesh, &screen, AX_SCREEN_CURVATURE, "curvature.png"),
                      "scale", screen.scale ? picture(d, &mesh, &screen, AX_SCREEN_SCALE, "scale.png") : json_null()));
    }
    ax_screen_free(&screen);
    ax_mesh_free(&mesh);
    if (status != AX_OK)
        call_by_name(error, file, name);
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

// What is cut, out of what, on what: in the words of the command's options. Profiles go by name here: their files may lie anywhere.
static ax_status choose_making(const char* joint, const char* material, const char* sheet, const char* profile_name,
                               ax_fabricate_options* options, ax_profile* profile, ax_error* error)
{
    if (profile_name && strpbrk(profile_name, "./"))
        return ax_fail(error, AX_USAGE, "export: \"profile\" is the name of one of the machine profiles.");
    ax_status status = ax_profile_find(profile_name ? profile_name : "generic", profile, error);
    if (status == AX_OK && joint)
        status = ax_fabricate_set_joint(options, joint, error);
    if (status == AX_OK && material)
        status = ax_fabricate_set_material(options, material, error);
    if (status == AX_OK && sheet)
        status = ax_fabricate_set_sheet(options, sheet, error);
    if (status == AX_OK && !(options->kerf >= 0 && options->kerf <= 10 && options->margin >= 0 &&
                             options->margin <= 1000 && options->spacing >= 0 && options->spacing <= 1000))
        status =
            ax_fail(error, AX_USAGE, "export: \"kerf\" is 0 to 10 mm, \"margin\" and \"spacing\" are 0 to 1000 mm.");
    options->profile = profile;
    return status;
}

// Offers every file of a folder that an export has filled; the folder itself goes when they are gone.
static ax_status offer_folder(desk* d, const char* folder, json_t* list, ax_error* error)
{
    struct dirent** entries;
    int count = scandir(folder, &entries, NULL, versionsort);
    ax_status status =
        count < 0 ? ax_fail(error, AX_FAILED, "The files cannot be read again: %s.", strerror(errno)) : AX_OK;
    for (int k = 0; k < count; ++k) {
        const char* name = entries[k]->d_name;
        size_t size = strlen(folder) + strlen(name) + 2;
        char *path = ax_alloc(size, 1), token[TOKEN_LENGTH + 1];
        struct stat about;
        snprintf(path, size, "%s/%s", folder, name);
        if (status == AX_OK && stat(path, &about) == 0 && S_ISREG(about.st_mode)) {
            status = files_offer(hub_files(d->hub), path, name, token, error);
            if (status == AX_OK)
                json_array_append_new(list,
                                      json_pack("{s:s, s:o, s:I}", "name", name, "url", json_sprintf("file/%s", token),
                                                "bytes", (json_int_t)about.st_size));
        }
        ax_free(path);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
    return status;
}

// The steps that are applied, as a recipe that can be played.
static ax_status write_recipe(const ax_session* session, const char* path, ax_error* error)
{
    if (ax_session_from_design(session))
        return ax_fail(error, AX_BAD_INPUT,
                       "This document began as a finished design, so it has no recipe of its own. Export the "
                       "design itself: .json.");
    char* text = ax_recipe_text(ax_session_recipe(session));
    ax_recipe* recipe;
    ax_status status = ax_recipe_parse(text, &recipe, error);
    ax_free(text);
    if (status != AX_OK)
        return status;
    while (ax_recipe_count(recipe) > ax_session_at(session))
        ax_recipe_remove(recipe, ax_recipe_count(recipe) - 1);
    status = ax_recipe_write(recipe, path, error);
    ax_recipe_free(recipe);
    return status;
}

// The finished design if there is one, else the states as they stand.
static ax_status write_design(desk* d, const char* path, ax_export_options* options, ax_error* error)
{
    if (d->exact)
        return ax_export(d->exact, path, options, error);
    ax_design design;
    ax_form_snapshot(ax_session_form(d->session), false, &design);
    ax_status status = ax_export(&design, path, options, error);
    ax_design_free(&design);
    return status;
}

static ax_status export(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char *ending, *word = NULL, *joint = NULL, *material = NULL, *sheet = NULL, *profile_name = NULL;
    const ax_progress progress = desk_progress(d);
    ax_cut_plan plan = {0};
    ax_profile profile;
    ax_fabricate_options making = ax_fabricate_options_default();
    const ax_moment* moments;
    int now;
    char day[16] = "";
    if (d->session && ax_session_history(d->session, &moments, &now))
        ax_day_words(moments[now].time, day);
    making.date = day;
    ax_export_options options = {.title = d->name, .fabricate = &making, .progress = &progress, .plan = &plan};
    ax_status status =
        message_unpack(&j->message, error, "{s:s, s?s, s?s, s?s, s?s, s?s, s?F, s?F, s?F}", "ending", &ending, "state",
                       &word, "joint", &joint, "material", &material, "sheet", &sheet, "profile", &profile_name, "kerf",
                       &making.kerf, "margin", &making.margin, "spacing", &making.spacing);
    if (status == AX_OK)
        status = choose_making(joint, material, sheet, profile_name, &making, &profile, error);
    if (status != AX_OK)
        return status;
    for (int s = AX_STATE_FLAT; word && s <= AX_STATE_SIMULATED; ++s)
        if (strcmp(word, ax_state_name((ax_state)s)) == 0)
            options.state = (ax_state)s;
    if (word && options.state == AX_STATE_DEFAULT)
        return ax_fail(error, AX_USAGE, "export: \"state\" is flat, deployed or simulated.");
    char name[NAME_LENGTH + 1];
    snprintf(name, sizeof name, "%.80s%.16s", d->name, ending);
    if (!files_name_is_plain(name) || *ending != '.')
        return ax_fail(error, AX_USAGE, "export: \"ending\" is an ending such as \".svg\".");
    char* folder = files_new_path(hub_files(d->hub), "");
    size_t size = strlen(folder) + NAME_LENGTH + 2;
    char* path = ax_alloc(size, 1);
    snprintf(path, size, "%s/%s", folder, name);
    json_t* list = json_array();
    if (mkdir(folder, 0700) != 0)
        status = ax_fail(error, AX_FAILED, "No file can be written: %s.", strerror(errno));
    if (status == AX_OK)
        status = strcmp(ending, ".recipe.json") == 0 ? write_recipe(d->session, path, error)
                                                     : write_design(d, path, &options, error);
    if (status == AX_OK)
        status = offer_folder(d, folder, list, error);
    if (status != AX_OK)
        rmdir(folder);
    *result = json_pack("{s:o, s:b, s:o}", "files", list, "exact", d->exact != NULL, "plan", describe_plan(&plan));
    ax_cut_plan_free(&plan);
    ax_free(path);
    ax_free(folder);
    return status;
}

// ---- opening and saving -------------------------------------------------------------------------------------------------------

static const char program[] = "auxshell studio";

static char* folder_of(const char* path)
{
    const char* slash = strrchr(path, '/');
    size_t length = slash == path ? 1 : (size_t)(slash - path);
    char* folder = ax_alloc(length + 1, 1);
    memcpy(folder, path, length);
    folder[length] = 0;
    return folder;
}

// "roof" of "/a/b/roof.auxshell"
static char* name_of(const char* path)
{
    const char* slash = strrchr(path, '/');
    char* name = ax_copy_text(slash ? slash + 1 : path);
    char* dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = 0;
    return name;
}

static bool ends_in(const char* text, const char* ending)
{
    size_t length = strlen(text), part = strlen(ending);
    return length > part && strcasecmp(text + length - part, ending) == 0;
}

// A document from steps. What was not edited is not kept when it is closed.
static ax_status create(desk* d, const ax_recipe* recipe, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    const ax_session_start start = {.recipe = recipe,
                                    .until = -1,
                                    .folder = d->folder,
                                    .program = program,
                                    .session = &d->session,
                                    .keep = AX_KEEP_BEFORE_ANY};
    ax_session* made = NULL;
    ax_status status = ax_session_create(d->path, &start, &progress, &made, error);
    d->session = made;
    const ax_moment* moments;
    int now;
    if (status == AX_OK)
        d->beginning = ax_session_history(d->session, &moments, &now);
    return status;
}

static ax_status create_from_file(desk* d, const char* file, ax_error* error)
{
    ax_recipe* recipe;
    ax_status status = ax_recipe_read(file, &recipe, error);
    if (status == AX_OK) {
        d->folder = folder_of(file);
        status = create(d, recipe, error);
        ax_recipe_free(recipe);
    }
    return status;
}

// Steps from a page, and the uploads they name, in a folder of their own.
static ax_status create_from_steps(desk* d, json_t* steps, json_t* uploads, ax_error* error)
{
    ax_status status = draft_folder(d->id, &d->folder, error);
    const char* name;
    json_t* token;
    json_object_foreach(uploads, name, token)
    {
        if (status == AX_OK)
            status = json_is_string(token) ? keep_upload(d, json_string_value(token), name, error)
                                           : ax_fail(error, AX_USAGE, "new: \"files\" names uploads by their tokens.");
    }
    if (status != AX_OK)
        return status;
    json_t* whole = json_pack("{s:s, s:i, s:O}", "format", "auxshell-recipe", "version", 1, "operators", steps);
    char* text = json_dumps(whole, JSON_COMPACT);
    json_decref(whole);
    ax_recipe* recipe = NULL;
    status = ax_recipe_parse(text, &recipe, error);
    free(text);
    if (status == AX_OK)
        status = create(d, recipe, error);
    ax_recipe_free(recipe);
    return status;
}

static ax_status open_session(desk* d, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    ax_status status = ax_session_open(d->path, true, program, &progress, &d->session, error);
    d->folder = folder_of(d->path);
    if (status == AX_OK && !ax_session_form(d->session)) {
        ax_session_close(d->session);
        d->session = NULL;
        status = ax_fail(error, AX_BAD_INPUT, "%s is empty: no step of it is applied.", d->path);
    }
    return status;
}

static bool same_steps(const ax_session* session, const ax_recipe* recipe)
{
    int count = ax_recipe_count(recipe);
    if (ax_session_at(session) != count || ax_recipe_count(ax_session_recipe(session)) != count)
        return false;
    for (int k = 0; k < count; ++k)
        if (strcmp(ax_recipe_operator(ax_session_recipe(session), k), ax_recipe_operator(recipe, k)) != 0)
            return false;
    return true;
}

// A copy of the document that the build made of the recipe, unless it was made of another one. False: there is none.
static bool open_made(desk* d, const char* made, const char* recipe_path)
{
    ax_recipe* recipe = NULL;
    bool opened = ax_recipe_read(recipe_path, &recipe, NULL) == AX_OK &&
                  copy_file(made, d->path, true, NULL) == AX_OK && open_session(d, NULL) == AX_OK;
    if (opened && !same_steps(d->session, recipe)) {
        ax_session_close(d->session);
        d->session = NULL;
        opened = false;
    }
    if (opened) {
        const ax_moment* moments;
        int now;
        d->beginning = ax_session_history(d->session, &moments, &now);
    } else {
        ax_free(d->folder);
        d->folder = NULL;
    }
    ax_recipe_free(recipe);
    return opened;
}

static ax_status create_from_example(desk* d, const char* name, ax_error* error)
{
    char *recipe = hello_example_path(name), *made = hello_example_document(name);
    ax_status status = AX_OK;
    if (!recipe)
        status = ax_fail(error, AX_BAD_INPUT, "There is no example \"%.100s\".", name);
    else if (made && open_made(d, made, recipe)) {
        ax_free(d->folder);
        d->folder = folder_of(recipe);
    } else
        status = create_from_file(d, recipe, error);
    ax_free(recipe);
    ax_free(made);
    return status;
}

ax_status job_open(desk* d, ax_error* error)
{
    desk_source* from = &d->source;
    bool document = from->path && ends_in(from->path, ".auxshell"), recipe = from->path && ends_in(from->path, ".json");
    if (from->path && !document && !recipe && access(from->path, F_OK) == 0)
        return ax_fail(error, AX_BAD_INPUT, "%s is neither a document (.auxshell) nor a recipe (.json).",
                       strrchr(from->path, '/') + 1);
    d->name = name_of(from->name ? from->name : from->path ? from->path : from->example ? from->example : "Untitled");
    if (document && !from->uploaded) {
        d->path = ax_copy_text(from->path);
        return open_session(d, error);
    }
    d->draft = true;
    ax_status status = draft_path(d->id, &d->path, error);
    if (status != AX_OK)
        return status;
    if (from->draft) {
        char title[DRAFT_TITLE];
        draft_title(d->id, title);
        ax_free(d->name);
        d->name = ax_copy_text(title);
        return open_session(d, error);
    }
    draft_set_title(d->id, d->name);
    if (document) {
        status = copy_file(from->path, d->path, false, error);
        return status == AX_OK ? open_session(d, error) : status;
    }
    if (from->path)
        return create_from_file(d, from->path, error);
    if (from->recipe)
        return create_from_steps(d, from->recipe, from->files, error);
    return create_from_example(d, from->example, error);
}

// A draft that nobody edited, or that is not wanted, goes.
void job_close(desk* d, bool discard)
{
    const ax_moment* moments;
    const ax_variant* variants;
    int now;
    bool unedited = d->session && d->beginning && ax_session_history(d->session, &moments, &now) == d->beginning &&
                    ax_session_variants(d->session, &variants) == 0;
    ax_session_close(d->session);
    d->session = NULL;
    d->exact = NULL;
    if (d->draft && (discard || unedited))
        draft_remove(d->id);
}

// The session in another file, from now on.
static ax_status move_to(desk* d, char* path, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    ax_session* moved;
    ax_status status = ax_session_copy(d->session, path, error);
    if (status == AX_OK)
        status = ax_session_open(path, true, program, &progress, &moved, error);
    if (status != AX_OK)
        return status;
    ax_session_close(d->session);
    d->session = moved;
    d->exact = NULL;
    char* old = ax_copy_text(d->id);
    desk_rename(d, files_relative(hub_files(d->hub), path));
    if (d->draft)
        draft_forget(old); // its files stay where steps find them
    ax_free(old);
    ax_free(d->path);
    ax_free(d->name);
    d->draft = false;
    d->path = ax_copy_text(path);
    d->name = name_of(path);
    return AX_OK;
}

static ax_status save(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char* name = NULL;
    int overwrite = 0;
    ax_status status = message_unpack(&j->message, error, "{s?s, s?b}", "path", &name, "overwrite", &overwrite);
    if (status != AX_OK)
        return status;
    if (!name && d->draft)
        return ax_fail(error, AX_USAGE, "save: the document has no name yet: give \"path\".");
    if (name) {
        char *path, *whole = ax_alloc(strlen(name) + sizeof ".auxshell", 1);
        sprintf(whole, "%s%s", name, ends_in(name, ".auxshell") ? "" : ".auxshell");
        status = files_within(hub_files(d->hub), whole, &path, error);
        ax_free(whole);
        if (status == AX_OK && strcmp(path, d->path) != 0) {
            desk_end_live(d);
            if (!overwrite && access(path, F_OK) == 0)
                status =
                    ax_fail(error, AX_BAD_INPUT, "There is a file %s already. Choose another name, or overwrite it.",
                            strrchr(path, '/') + 1);
            else
                status = move_to(d, path, error);
        }
        ax_free(path);
    }
    if (status == AX_OK)
        *result = json_pack("{s:s, s:s}", "path", files_relative(hub_files(d->hub), d->path), "document", d->id);
    return status;
}

const job_type job_types_files[] = {
    {"check", false, check, false},
    {"keep", false, keep, false},
    {"export", false, export, false},
    {"save", false, save, false},
    {0},
};
