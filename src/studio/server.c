// HTTP and WebSocket on the loopback interface, with libwebsockets: one thread, which owns every connection. Safety is decided here:
// who may speak at all (Host, Origin, the secret), how much, and how fast. What is said goes to the hub.
#include "ax/studio.h"

#include "studio/hub.h"
#include "studio/page.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <libwebsockets.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RATE = 200, BURST = 400, HEADER_ROOM = 2048, CHUNK = 1 << 16, SOCKETS_MOST = 256, FAREWELLS = 20 };

struct ax_studio {
    struct lws_context* context;
    struct lws_vhost* host;
    pthread_t thread;
    hub* hub;
    bool stopping; // atomic
    char secret[SECRET_LENGTH + 1];
    char address[64 + SECRET_LENGTH];
    char hosts[2][32], origins[2][40]; // what Host and Origin may be
};

typedef enum connection_kind {
    CONNECTION_NEW,
    CONNECTION_DOWNLOAD,
    CONNECTION_UPLOAD,
    CONNECTION_SOCKET
} connection_kind;

typedef struct connection {
    connection_kind kind;
    // download: from memory, or from a file that is removed then
    const unsigned char *at, *end;
    int file;
    char* path;
    // upload
    size_t arrived, expected;
    char name[NAME_LENGTH + 1];
    // socket
    hub_client* client;
    char* text; // of the message that is arriving
    size_t size, room;
    double tokens; // messages it may still send
    lws_usec_t counted;
} connection;

// ---- who may speak ------------------------------------------------------------------------------------------------------------

static bool header_is(struct lws* wsi, enum lws_token_indexes token, const char* const* allowed, int count)
{
    char value[64];
    if (lws_hdr_copy(wsi, value, sizeof value, token) <= 0)
        return false;
    for (int k = 0; k < count; ++k)
        if (strcmp(value, allowed[k]) == 0)
            return true;
    return false;
}

// Another site's page reaches 127.0.0.1 too, by its own name if it makes that name lead here (rebinding), which Host shows, or by
// ours, which Origin shows. Navigation and its files send no Origin.
static bool host_allowed(const ax_studio* s, struct lws* wsi)
{
    return header_is(wsi, WSI_TOKEN_HOST, (const char* const[]){s->hosts[0], s->hosts[1]}, 2);
}

static bool origin_allowed(const ax_studio* s, struct lws* wsi, bool must)
{
    if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) <= 0)
        return !must;
    return header_is(wsi, WSI_TOKEN_ORIGIN, (const char* const[]){s->origins[0], s->origins[1]}, 2);
}

// ---- answers over HTTP --------------------------------------------------------------------------------------------------------

static const char page_policy[] =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; font-src 'self'; "
    "img-src 'self' blob: data:; connect-src 'self'; worker-src 'self' blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";
// rhino3dm binds its classes with `new Function`. It runs in a worker of its own, which has this policy and sees no page.
static const char rhino_policy[] = "default-src 'none'; script-src 'self' 'unsafe-eval'; connect-src 'self'";

static const struct {
    const char *name, *value;
} headers[] = {
    {"x-content-type-options:", "nosniff"},
    {"referrer-policy:", "no-referrer"},
    {"cross-origin-opener-policy:", "same-origin"},
    {"cross-origin-resource-policy:", "same-origin"},
    {"cache-control:", "no-store"},
};

// Headers, and the body after them if it is short. Nonzero when the connection is to be closed.
static int respond_under(const char* policy, struct lws* wsi, unsigned status, const char* type, size_t size,
                         const char* name, const void* body)
{
    unsigned char block[LWS_PRE + HEADER_ROOM], *start = block + LWS_PRE, *at = start, *end = block + sizeof block - 1;
    if (lws_add_http_common_headers(wsi, status, type, size, &at, end) ||
        lws_add_http_header_by_name(wsi, (const unsigned char*)"content-security-policy:", (const unsigned char*)policy,
                                    (int)strlen(policy), &at, end))
        return -1;
    for (size_t k = 0; k < sizeof headers / sizeof *headers; ++k)
        if (lws_add_http_header_by_name(wsi, (const unsigned char*)headers[k].name,
                                        (const unsigned char*)headers[k].value, (int)strlen(headers[k].value), &at,
                                        end))
            return -1;
    char value[3 * NAME_LENGTH + 64];
    if (name) { // RFC 6266: the name in UTF-8, everything but letters and digits escaped
        char* to = value + sprintf(value, "attachment; filename*=UTF-8''");
        for (const unsigned char* c = (const unsigned char*)name; *c; ++c)
            to += sprintf(to, (*c < 128 && isalnum(*c)) || *c == '.' || *c == '-' ? "%c" : "%%%02X", *c);
        if (lws_add_http_header_by_name(wsi, (const unsigned char*)"content-disposition:", (const unsigned char*)value,
                                        (int)(to - value), &at, end))
            return -1;
    }
    if (lws_finalize_write_http_header(wsi, start, &at, end))
        return -1;
    if (!body)
        return 0;
    unsigned char text[LWS_PRE + 512];
    memcpy(text + LWS_PRE, body, size);
    if (lws_write(wsi, text + LWS_PRE, size, LWS_WRITE_HTTP_FINAL) < 0)
        return -1;
    return lws_http_transaction_completed(wsi) ? -1 : 0;
}

static int respond(struct lws* wsi, unsigned status, const char* type, size_t size, const char* name, const void* body)
{
    return respond_under(page_policy, wsi, status, type, size, name, body);
}

static int refuse(struct lws* wsi, unsigned status, const char* words)
{
    return respond(wsi, status, "text/plain; charset=utf-8", strlen(words), NULL, words);
}

static int send_page_file(struct lws* wsi, connection* c, const page_file* file)
{
    *c = (connection){.kind = CONNECTION_DOWNLOAD, .at = file->bytes, .end = file->end, .file = -1};
    const char* policy = strncmp(file->name, "assets/rhino-worker", 19) == 0 ? rhino_policy : page_policy;
    if (respond_under(policy, wsi, 200, file->type, (size_t)(file->end - file->bytes), NULL, NULL))
        return -1;
    lws_callback_on_writable(wsi);
    return 0;
}

static int send_offer(ax_studio* s, struct lws* wsi, connection* c, const char* token)
{
    char* path;
    char name[NAME_LENGTH + 1];
    if (!files_take(hub_files(s->hub), token, &path, name))
        return refuse(wsi, 404, "There is no such file (any more). Export again.\n");
    int file = open(path, O_RDONLY | O_CLOEXEC);
    off_t size = file < 0 ? -1 : lseek(file, 0, SEEK_END);
    if (size < 0 || lseek(file, 0, SEEK_SET) != 0) {
        if (file >= 0)
            close(file);
        files_remove(hub_files(s->hub), path);
        ax_free(path);
        return refuse(wsi, 500, "The file cannot be read any more. Export again.\n");
    }
    *c = (connection){.kind = CONNECTION_DOWNLOAD, .file = file, .path = path};
    bool picture = strlen(name) > 4 && strcmp(name + strlen(name) - 4, ".png") == 0;
    if (respond(wsi, 200, picture ? "image/png" : "application/octet-stream", (size_t)size, name, NULL))
        return -1;
    lws_callback_on_writable(wsi);
    return 0;
}

static int send_chunk(struct lws* wsi, connection* c)
{
    unsigned char block[LWS_PRE + CHUNK], *start = block + LWS_PRE;
    size_t size;
    bool last;
    if (c->at) {
        size = (size_t)(c->end - c->at) < CHUNK ? (size_t)(c->end - c->at) : CHUNK;
        memcpy(start, c->at, size);
        c->at += size;
        last = c->at == c->end;
    } else {
        ssize_t got = read(c->file, start, CHUNK);
        if (got < 0)
            return -1;
        size = (size_t)got;
        last = size < CHUNK;
    }
    if (lws_write(wsi, start, size, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0)
        return -1;
    if (last)
        return lws_http_transaction_completed(wsi) ? -1 : 0;
    lws_callback_on_writable(wsi);
    return 0;
}

// ---- uploads ------------------------------------------------------------------------------------------------------------------

static int begin_upload(ax_studio* s, struct lws* wsi, connection* c)
{
    if (!origin_allowed(s, wsi, true))
        return refuse(wsi, 403, "Uploads come from the studio's own page only.\n");
    char length[24], argument[3 * NAME_LENGTH];
    if (lws_hdr_copy(wsi, length, sizeof length, WSI_TOKEN_HTTP_CONTENT_LENGTH) <= 0)
        return refuse(wsi, 411, "An upload says its length first.\n");
    char* end;
    unsigned long long expected = strtoull(length, &end, 10);
    if (*end || *length == '-' || expected > UPLOAD_BYTES)
        return refuse(wsi, 413, "Files up to 64 MiB can be uploaded.\n");
    const char* name = lws_get_urlarg_by_name(wsi, "name=", argument, sizeof argument);
    if (!name || !files_name_is_plain(name))
        return refuse(wsi, 400, "An upload has a plain file name: upload?name=dome.obj\n");
    *c = (connection){.kind = CONNECTION_UPLOAD, .expected = (size_t)expected};
    snprintf(c->name, sizeof c->name, "%s", name);
    c->path = files_new_path(hub_files(s->hub), name);
    c->file = open(c->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    return c->file < 0 ? refuse(wsi, 507, "The file cannot be stored.\n") : 0;
}

static int take_upload(struct lws* wsi, connection* c, const char* bytes, size_t size)
{
    if (c->kind != CONNECTION_UPLOAD || c->file < 0)
        return -1;
    c->arrived += size;
    if (c->arrived > c->expected)
        return -1;
    while (size) {
        ssize_t wrote = write(c->file, bytes, size);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote <= 0) {
            refuse(wsi, 507, "The file cannot be stored: the disk is full.\n");
            return -1;
        }
        bytes += wrote;
        size -= (size_t)wrote;
    }
    return 0;
}

static int end_upload(ax_studio* s, struct lws* wsi, connection* c)
{
    if (c->kind != CONNECTION_UPLOAD || c->file < 0)
        return -1;
    int failed = close(c->file);
    c->file = -1;
    char token[TOKEN_LENGTH + 1];
    if (failed || files_uploaded(hub_files(s->hub), c->path, c->name, token, NULL) != AX_OK)
        return refuse(wsi, 507, "The file cannot be stored: the disk is full.\n");
    ax_free(c->path); // the file stays
    c->path = NULL;
    json_t* answer = json_pack("{s:s, s:s, s:I}", "upload", token, "name", c->name, "bytes", (json_int_t)c->arrived);
    char* text = answer ? json_dumps(answer, JSON_COMPACT) : NULL;
    json_decref(answer);
    int result = text ? respond(wsi, 200, "application/json", strlen(text), NULL, text)
                      : refuse(wsi, 400, "The name of the file is no text.\n");
    free(text);
    return result;
}

// ---- requests -----------------------------------------------------------------------------------------------------------------

static int request(ax_studio* s, struct lws* wsi, connection* c)
{
    char* uri;
    int length, method = lws_http_get_uri_and_method(wsi, &uri, &length);
    if (!host_allowed(s, wsi) || !origin_allowed(s, wsi, false))
        return refuse(wsi, 403, "This studio serves its own page only.\n");
    if (length < 1 + SECRET_LENGTH || !secret_equal(uri + 1, s->secret, SECRET_LENGTH))
        return refuse(wsi, 404, "Use the address that the studio printed.\n");
    const char* path = uri + 1 + SECRET_LENGTH;
    if (method == LWSHUMETH_POST)
        return strcmp(path, "/upload") == 0 ? begin_upload(s, wsi, c)
                                            : refuse(wsi, 404, "Nothing can be sent there.\n");
    if (method != LWSHUMETH_GET)
        return refuse(wsi, 405, "GET, or POST for uploads.\n");
    if (strncmp(path, "/file/", 6) == 0)
        return send_offer(s, wsi, c, path + 6);
    if (*path != '/')
        return refuse(wsi, 404, "The address ends in a slash.\n");
    const char* name = path[1] ? path + 1 : page_files[0].name;
    for (int k = 0; k < page_file_count; ++k)
        if (strcmp(name, page_files[k].name) == 0)
            return send_page_file(wsi, c, &page_files[k]);
    return refuse(wsi, 404, "The page has no such file.\n");
}

static void end_connection(ax_studio* s, connection* c)
{
    if (c->kind != CONNECTION_DOWNLOAD && c->kind != CONNECTION_UPLOAD)
        return;
    if (c->file >= 0 && !c->at)
        close(c->file);
    if (c->path) { // a download that was fetched, or an upload that did not end
        files_remove(hub_files(s->hub), c->path);
        ax_free(c->path);
    }
    *c = (connection){0};
}

// Decides on the upgrade to a WebSocket: 0 yes, 1 refused with a response.
static int upgrade(ax_studio* s, struct lws* wsi)
{
    char path[8], argument[SECRET_LENGTH + 8];
    const char* key = lws_get_urlarg_by_name(wsi, "key=", argument, sizeof argument);
    bool here = lws_hdr_copy(wsi, path, sizeof path, WSI_TOKEN_GET_URI) > 0 && strcmp(path, "/ws") == 0;
    if (!host_allowed(s, wsi) || !origin_allowed(s, wsi, true))
        refuse(wsi, 403, "This studio speaks with its own page only.\n");
    else if (!here || !key || strlen(key) != SECRET_LENGTH || !secret_equal(key, s->secret, SECRET_LENGTH))
        refuse(wsi, 404, "Use the address that the studio printed.\n");
    else
        return 0;
    return 1;
}

// ---- sockets ------------------------------------------------------------------------------------------------------------------

static int close_with(struct lws* wsi, enum lws_close_status status, const char* words)
{
    lws_close_reason(wsi, status, (unsigned char*)words, strlen(words));
    return -1;
}

// A client that says too much is read no faster: its messages wait in its own socket.
static void count_message(struct lws* wsi, connection* c)
{
    lws_usec_t now = lws_now_usecs();
    c->tokens += (double)(now - c->counted) * 1e-6 * RATE;
    if (c->tokens > BURST)
        c->tokens = BURST;
    c->counted = now;
    c->tokens -= 1;
    if (c->tokens < 1) {
        lws_rx_flow_control(wsi, 0);
        lws_set_timer_usecs(wsi, (lws_usec_t)(1e6 / RATE * (RATE / 10)));
    }
}

static int take_text(ax_studio* s, struct lws* wsi, connection* c, const char* bytes, size_t size)
{
    if (lws_frame_is_binary(wsi))
        return close_with(wsi, LWS_CLOSE_STATUS_UNACCEPTABLE_OPCODE, "text only");
    if (lws_is_first_fragment(wsi))
        c->size = 0;
    if (c->size + size + lws_remaining_packet_payload(wsi) > MESSAGE_BYTES)
        return close_with(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, "messages have up to 1 MiB");
    if (c->size + size > c->room) {
        c->room = 2 * (c->size + size);
        c->text = ax_realloc(c->text, c->room, 1);
    }
    if (size)
        memcpy(c->text + c->size, bytes, size);
    c->size += size;
    if (!lws_is_final_fragment(wsi))
        return 0;
    count_message(wsi, c);
    hub_receive(s->hub, c->client, c->text ? c->text : "", c->size);
    if (c->room > 1 << 16) { // one long stroke must not hold a megabyte for ever
        ax_free(c->text);
        c->text = NULL;
        c->room = 0;
    }
    c->size = 0;
    return 0;
}

static int send_next(ax_studio* s, struct lws* wsi, connection* c)
{
    parcel p;
    if (!hub_next(s->hub, c->client, &p))
        return 0;
    int wrote = lws_write(wsi, p.block + LWS_PRE, p.size, p.binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
    ax_free(p.block);
    if (wrote < 0)
        return -1;
    if (hub_waiting(s->hub, c->client))
        lws_callback_on_writable(wsi);
    return 0;
}

static int serve(struct lws* wsi, enum lws_callback_reasons reason, void* user, void* in, size_t size)
{
    ax_studio* s = lws_context_user(lws_get_context(wsi));
    connection* c = user;
    switch (reason) {
    case LWS_CALLBACK_HTTP:
        return request(s, wsi, c);
    case LWS_CALLBACK_HTTP_WRITEABLE:
        return c->kind == CONNECTION_DOWNLOAD ? send_chunk(wsi, c) : 0;
    case LWS_CALLBACK_HTTP_BODY:
        return take_upload(wsi, c, in, size);
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
        return end_upload(s, wsi, c);
    case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
    case LWS_CALLBACK_CLOSED_HTTP:
        if (c)
            end_connection(s, c);
        return 0;
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
        return upgrade(s, wsi);
    case LWS_CALLBACK_ESTABLISHED:
        *c = (connection){.kind = CONNECTION_SOCKET, .tokens = BURST, .counted = lws_now_usecs()};
        c->client = hub_join(s->hub);
        if (!c->client)
            return close_with(wsi, 1013, "too many pages are open");
        lws_callback_on_writable(wsi);
        return 0;
    case LWS_CALLBACK_RECEIVE:
        return take_text(s, wsi, c, in, size);
    case LWS_CALLBACK_TIMER:
        lws_rx_flow_control(wsi, 1);
        return 0;
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return c->client ? send_next(s, wsi, c) : 0;
    case LWS_CALLBACK_CLOSED:
        if (c->client)
            hub_leave(s->hub, c->client);
        ax_free(c->text);
        *c = (connection){0};
        return 0;
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED: // someone has something to say
        lws_callback_on_writable_all_protocol(s->context, lws_get_protocol(wsi));
        return 0;
    default:
        return 0;
    }
}

static const struct lws_protocols protocols[] = {
    {.name = "auxshell", .callback = serve, .per_session_data_size = sizeof(connection), .rx_buffer_size = CHUNK}, {0}};

// ---- life ---------------------------------------------------------------------------------------------------------------------

static void wake(void* context)
{
    ax_studio* s = context;
    if (s->context)
        lws_cancel_service(s->context);
}

static void* run(void* context)
{
    ax_studio* s = context;
    while (!__atomic_load_n(&s->stopping, __ATOMIC_ACQUIRE) && lws_service(s->context, 0) >= 0)
        ;
    hub_end_desks(s->hub);
    hub_say_bye(s->hub, "The studio was ended. Everything is saved.");
    for (int k = 0; k < FAREWELLS && lws_service(s->context, -1) >= 0; ++k) // pages that read get it
        usleep(5000);
    return NULL;
}

static ax_status open_port(ax_studio* s, int port, ax_error* error)
{
    lws_set_log_level(0, NULL); // a library does not print
    const struct lws_context_creation_info info = {
        .port = port,
        .iface = "127.0.0.1",
        .protocols = protocols,
        .user = s,
        .options = LWS_SERVER_OPTION_VALIDATE_UTF8 | LWS_SERVER_OPTION_DISABLE_IPV6 |
                   LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND,
        .timeout_secs = 10,
        .keepalive_timeout = 10,
        .fd_limit_per_thread = SOCKETS_MOST,
        .max_http_header_data = 4096,
        .pt_serv_buf_size = CHUNK,
        .server_string = "auxshell",
    };
    s->context = lws_create_context(&info);
    if (!s->context && port)
        return ax_fail(error, AX_FAILED,
                       "Port %d cannot be had: another program uses it. Choose another with --port, or leave "
                       "it out.",
                       port);
    if (!s->context)
        return ax_fail(error, AX_FAILED, "No port of the loopback interface can be had.");
    s->host = lws_get_vhost_by_name(s->context, "default");
    port = lws_get_vhost_listen_port(s->host);
    const char* const names[] = {"127.0.0.1", "localhost"};
    for (int k = 0; k < 2; ++k) {
        snprintf(s->hosts[k], sizeof s->hosts[k], "%s:%d", names[k], port);
        snprintf(s->origins[k], sizeof s->origins[k], "http://%s", s->hosts[k]);
    }
    snprintf(s->address, sizeof s->address, "http://127.0.0.1:%d/%s/", port, s->secret);
    return AX_OK;
}

static void release(ax_studio* s)
{
    if (s->context)
        lws_context_destroy(s->context);
    s->context = NULL;
    hub_close(s->hub);
    ax_free(s);
}

ax_status ax_studio_start(const ax_studio_options* options, ax_studio** out, ax_error* error)
{
    *out = NULL;
    ax_studio* s = AX_NEW0(ax_studio, 1);
    sigset_t all, before; // every thread of the studio inherits the mask: signals are the caller's
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    ax_status status = secret_make(s->secret, SECRET_LENGTH, error);
    if (status == AX_OK)
        status = hub_open(options->folder, LWS_PRE, wake, s, &s->hub, error);
    if (status == AX_OK)
        status = open_port(s, options->port, error);
    if (status == AX_OK)
        status = hub_start(s->hub, options->document, error);
    if (status == AX_OK && pthread_create(&s->thread, NULL, run, s) != 0)
        status = ax_fail(error, AX_FAILED, "The server's thread cannot be started: %s.", strerror(errno));
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (status != AX_OK)
        release(s);
    else
        *out = s;
    return status;
}

const char* ax_studio_address(const ax_studio* studio)
{
    return studio->address;
}

void ax_studio_stop(ax_studio* studio)
{
    __atomic_store_n(&studio->stopping, true, __ATOMIC_RELEASE);
    lws_cancel_service(studio->context);
    pthread_join(studio->thread, NULL);
    release(studio);
}
