// The studio's parts below its threads: frames, messages, and the files it may touch.
#include "studio/board.h"
#include "studio/draft.h"
#include "studio/files.h"
#include "studio/message.h"
#include "support/test.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// ---- frames -------------------------------------------------------------------------------------------------------------------

// Section numbers of a frame, in order, after its header and sizes were checked; -1 ends them.
static void sections_of(const unsigned char* frame, size_t size, int* sections)
{
    uint32_t head[8], at = sizeof head;
    memcpy(head, frame, sizeof head);
    assert_int_equal(head[0], 0x31465841);
    for (uint32_t k = 0; k < head[7]; ++k) {
        uint32_t s[3];
        memcpy(s, frame + at, sizeof s);
        sections[k] = (int)s[0];
        at += (uint32_t)sizeof s + ((s[2] * (s[1] == SECTION_U8 ? 1 : 4) + 3) & ~3u);
    }
    sections[head[7]] = -1;
    assert_int_equal(at, size);
}

static void a_frame_holds_what_changed_since(void** state)
{
    (void)state;
    board b = {0};
    const double flat[4] = {1e6 + 0.25, 2, 3e6, 4}, origin[2] = {1e6, 0};
    const int triangles[3] = {2, 1, 0};
    const unsigned char rim[5] = {1, 0, 1, 0, 1};
    int s[SECTION_LIMIT];
    size_t size;
    board_put_numbers(&b, SECTION_FLAT, 4, flat, 2, origin);
    board_put_ints(&b, SECTION_TRIANGLES, 3, triangles);
    board_put_bytes(&b, SECTION_ON_RIM, 5, rim);
    board_clear(&b, SECTION_SIMULATED, SECTION_F32);
    unsigned char* frame = board_frame(&b, (frame_header){.kind = FRAME_STATE, .serial = 7}, 0, 16, &size);
    sections_of(frame + 16, size, s);
    assert_int_equal(s[0], SECTION_TRIANGLES);
    assert_int_equal(s[1], SECTION_ON_RIM);
    assert_int_equal(s[2], SECTION_FLAT);
    assert_int_equal(s[3], SECTION_SIMULATED);
    assert_int_equal(s[4], -1);
    uint32_t serial;
    memcpy(&serial, frame + 16 + 20, 4);
    assert_int_equal(serial, 7);
    ax_free(frame);

    // nothing differs, nothing is sent; the origin is taken off before single precision
    unsigned seen = b.stamp;
    board_put_numbers(&b, SECTION_FLAT, 4, flat, 2, origin);
    board_put_ints(&b, SECTION_TRIANGLES, 3, triangles);
    board_clear(&b, SECTION_SIMULATED, SECTION_F32);
    assert_int_equal(b.stamp, seen);
    frame = board_frame(&b, (frame_header){.kind = FRAME_STATE}, seen, 0, &size);
    sections_of(frame, size, s);
    assert_int_equal(s[0], -1);
    ax_free(frame);
    float first;
    memcpy(&first, b.sections[SECTION_FLAT].data, 4);
    assert_true(first == 0.25f);

    const double moved[4] = {1e6 + 0.5, 2, 3e6, 4};
    board_put_numbers(&b, SECTION_FLAT, 4, moved, 2, origin);
    board_put_numbers(&b, SECTION_SIMULATED, 4, moved, 2, origin);
    frame = board_frame(&b, (frame_header){.kind = FRAME_STATE}, seen, 0, &size);
    sections_of(frame, size, s);
    assert_int_equal(s[0], SECTION_FLAT);
    assert_int_equal(s[1], SECTION_SIMULATED);
    assert_int_equal(s[2], -1);
    ax_free(frame);
    board_free(&b);
}

// ---- messages -----------------------------------------------------------------------------------------------------------------

static ax_status read_text(const char* text, message* m, ax_error* error)
{
    return message_read(text, strlen(text), m, error);
}

static void commands_are_read_with_their_id(void** state)
{
    (void)state;
    message m;
    int at;
    assert_int_equal(read_text("{\"do\": \"goto\", \"id\": 2147483647, \"at\": 3}", &m, NULL), AX_OK);
    assert_string_equal(m.action, "goto");
    assert_int_equal(m.id, 2147483647);
    assert_int_equal(message_unpack(&m, NULL, "{s:i}", "at", &at), AX_OK);
    assert_int_equal(at, 3);
    message_free(&m);
}

static void what_is_no_command_is_refused_and_still_answered(void** state)
{
    (void)state;
    const struct {
        const char *text, *words;
        int id;
    } cases[] = {
        {"", "no JSON", 0},
        {"[1]", "no JSON object", 0},
        {"{\"do\": \"undo\"} x", "no JSON", 0},
        {"{\"do\": \"undo\", \"do\": \"redo\"}", "duplicate", 0},
        {"{\"id\": 5}", "names no command", 5},
        {"{\"id\": 5, \"do\": 7}", "names no command", 5},
        {"{\"id\": 5, \"do\": \"a command whose name does not end\"}", "names no command", 5},
        {"{\"id\": 0, \"do\": \"undo\"}", "whole number", 0},
        {"{\"id\": 1.5, \"do\": \"undo\"}", "whole number", 0},
        {"{\"id\": 2147483648, \"do\": \"undo\"}", "whole number", 0},
        {"{\"do\": \"a\", \"x\": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}", "deeper", 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        message m;
        ax_error error = {0};
        assert_int_equal(read_text(cases[k].text, &m, &error), AX_USAGE);
        if (!strstr(error.message, cases[k].words))
            print_error("%s\n  wanted %s, got %s\n", cases[k].text, cases[k].words, error.message);
        assert_non_null(strstr(error.message, cases[k].words));
        assert_int_equal(m.id, cases[k].id);
        message_free(&m);
    }
    message m;
    assert_int_equal(
        read_text("{\"do\": \"a\", \"x\": \"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\\\"[[[[[\"}", &m, NULL), AX_OK);
    message_free(&m); // brackets in a text are no nesting
}

static void parameters_that_are_unknown_missing_or_wrong_are_refused(void** state)
{
    (void)state;
    const char* const texts[] = {"{\"do\": \"goto\"}", "{\"do\": \"goto\", \"at\": \"3\"}",
                                 "{\"do\": \"goto\", \"at\": 3, \"too\": 1}"};
    for (int k = 0; k < 3; ++k) {
        message m;
        int at;
        ax_error error = {0};
        assert_int_equal(read_text(texts[k], &m, NULL), AX_OK);
        assert_int_equal(message_unpack(&m, &error, "{s:i}", "at", &at), AX_USAGE);
        assert_memory_equal(error.message, "goto: ", 6);
        message_free(&m);
    }
}

// ---- files --------------------------------------------------------------------------------------------------------------------

typedef struct place {
    char folder[64], inner[128];
    files* files;
} place;

static int open_place(void** state)
{
    place* p = AX_NEW0(place, 1);
    strcpy(p->folder, "/tmp/auxshell-test-XXXXXX");
    if (!mkdtemp(p->folder))
        return -1;
    snprintf(p->inner, sizeof p->inner, "%s/inner", p->folder);
    mkdir(p->inner, 0700);
    *state = p;
    return files_open(p->inner, &p->files, NULL) == AX_OK ? 0 : -1;
}

static int close_place(void** state)
{
    place* p = *state;
    char command[128];
    files_close(p->files);
    snprintf(command, sizeof command, "rm -r '%s'", p->folder);
    int failed = system(command);
    ax_free(p);
    return failed;
}

static void write_file(const char* path, const char* text)
{
    FILE* file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void paths_stay_within_the_folder(void** state)
{
    place* p = *state;
    char path[256], *whole;
    snprintf(path, sizeof path, "%s/secret.json", p->folder);
    write_file(path, "x");
    snprintf(path, sizeof path, "%s/link.json", p->inner);
    assert_int_equal(symlink("../secret.json", path), 0);
    snprintf(path, sizeof path, "%s/way", p->inner);
    assert_int_equal(symlink("..", path), 0);
    snprintf(path, sizeof path, "%s-beside", p->inner); // a folder whose name begins alike
    assert_int_equal(mkdir(path, 0700), 0);
    const char* const refused[] = {"",
                                   "/etc/passwd",
                                   "../secret.json",
                                   "link.json",
                                   "way/secret.json",
                                   "a/../../b",
                                   ".",
                                   "..",
                                   ".hidden",
                                   "missing/x.json",
                                   "x/",
                                   "a\nb.json",
                                   "../inner-beside/x.json"};
    for (size_t k = 0; k < sizeof refused / sizeof *refused; ++k) {
        ax_error error = {0};
        if (files_within(p->files, refused[k], &whole, &error) != AX_BAD_INPUT)
            print_error("not refused: %s\n", refused[k]);
        assert_null(whole);
        assert_true(*error.message);
    }
    assert_int_equal(files_within(p->files, "new.json", &whole, NULL), AX_OK);
    assert_string_equal(files_relative(p->files, whole), "new.json");
    ax_free(whole);
    assert_int_equal(files_within(p->files, "../inner/new.json", &whole, NULL), AX_OK); // out and back in
    assert_string_equal(files_relative(p->files, whole), "new.json");
    ax_free(whole);
}

static void an_offer_is_taken_once_and_an_upload_stays(void** state)
{
    place* p = *state;
    char token[TOKEN_LENGTH + 1], other[TOKEN_LENGTH + 1], name[NAME_LENGTH + 1], *path, *taken;
    path = files_new_path(p->files, "roof.svg");
    assert_string_equal(path + strlen(path) - 4, ".svg");
    write_file(path, "x");
    assert_int_equal(files_offer(p->files, path, "roof.svg", token, NULL), AX_OK);
    assert_int_not_equal(files_upload(p->files, token, &taken, name, NULL), AX_OK); // an offer is no upload
    assert_false(files_take(p->files, "nothing", &taken, name));
    assert_true(files_take(p->files, token, &taken, name));
    assert_string_equal(name, "roof.svg");
    assert_string_equal(taken, path);
    assert_false(files_take(p->files, token, &taken, name));
    unlink(path);
    ax_free(path);
    ax_free(taken);

    path = files_new_path(p->files, "dome.obj");
    write_file(path, "x");
    assert_int_equal(files_uploaded(p->files, path, "dome.obj", other, NULL), AX_OK);
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(files_upload(p->files, other, &taken, name, NULL), AX_OK);
        assert_string_equal(name, "dome.obj");
        ax_free(taken);
    }
    assert_false(files_take(p->files, other, &taken, name)); // and cannot be downloaded
    ax_free(path);
}

static void old_tickets_make_room_for_new_ones(void** state)
{
    place* p = *state;
    char first[TOKEN_LENGTH + 1], token[TOKEN_LENGTH + 1], name[NAME_LENGTH + 1], *path, *taken;
    for (int k = 0; k < 300; ++k) {
        path = files_new_path(p->files, "a.obj");
        write_file(path, "x");
        assert_int_equal(files_uploaded(p->files, path, "a.obj", k ? token : first, NULL), AX_OK);
        if (k < 299)
            ax_free(path);
    }
    assert_int_equal(files_upload(p->files, first, &taken, name, NULL), AX_BAD_INPUT);
    assert_int_equal(files_upload(p->files, token, &taken, name, NULL), AX_OK);
    assert_string_equal(taken, path);
    ax_free(taken);
    ax_free(path);
}

static void secrets_differ_and_are_compared_whole(void** state)
{
    (void)state;
    char a[SECRET_LENGTH + 1], b[SECRET_LENGTH + 1];
    assert_int_equal(secret_make(a, SECRET_LENGTH, NULL), AX_OK);
    assert_int_equal(secret_make(b, SECRET_LENGTH, NULL), AX_OK);
    assert_int_equal(strlen(a), SECRET_LENGTH);
    assert_int_equal(strspn(a, "abcdefghijkmnpqrstuvwxyz23456789"), SECRET_LENGTH);
    assert_false(secret_equal(a, b, SECRET_LENGTH));
    memcpy(b, a, sizeof a);
    assert_true(secret_equal(a, b, SECRET_LENGTH));
    b[SECRET_LENGTH - 1] ^= 1;
    assert_false(secret_equal(a, b, SECRET_LENGTH));
}

static void drafts_are_found_again(void** state)
{
    place* p = *state;
    char id[DRAFT_ID], *path;
    setenv("XDG_STATE_HOME", p->inner, 1);
    assert_int_equal(draft_new_id(id, NULL), AX_OK);
    assert_false(draft_exists(id));
    assert_int_equal(draft_path(id, &path, NULL), AX_OK);
    write_file(path, "x");
    assert_true(draft_exists(id));
    assert_false(draft_exists("draft-../../x"));
    json_t* list = draft_list();
    assert_int_equal(json_array_size(list), 1);
    assert_string_equal(json_string_value(json_object_get(json_array_get(list, 0), "name")), id);
    json_decref(list);
    ax_free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_holds_what_changed_since),
        cmocka_unit_test(commands_are_read_with_their_id),
        cmocka_unit_test(what_is_no_command_is_refused_and_still_answered),
        cmocka_unit_test(parameters_that_are_unknown_missing_or_wrong_are_refused),
        cmocka_unit_test_setup_teardown(paths_stay_within_the_folder, open_place, close_place),
        cmocka_unit_test_setup_teardown(an_offer_is_taken_once_and_an_upload_stays, open_place, close_place),
        cmocka_unit_test_setup_teardown(old_tickets_make_room_for_new_ones, open_place, close_place),
        cmocka_unit_test(secrets_differ_and_are_compared_whole),
        cmocka_unit_test_setup_teardown(drafts_are_found_again, open_place, close_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
