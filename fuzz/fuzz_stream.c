// What the parsing process sends is not trusted: no stream may crash the receiver.
#include "mesh/stream.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

typedef struct bytes {
    const uint8_t* at;
    size_t left;
} bytes;

static bool take(void* context, void* into, size_t size)
{
    bytes* rest = context;
    if (size > rest->left)
        return false;
    memcpy(into, rest->at, size);
    rest->at += size;
    rest->left -= size;
    return true;
}

// The magic, the counts in bounds that inputs can reach, and the end are put in place most of the time, so that the
// fuzzer need not guess them.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    uint8_t* stream = malloc(size ? size : 1);
    memcpy(stream, data, size);
    if (size > sizeof(ax_stream_header) + sizeof ax_stream_end && data[0] % 4) {
        memcpy(stream, ax_stream_magic, sizeof ax_stream_magic);
        memcpy(stream + size - sizeof ax_stream_end, ax_stream_end, sizeof ax_stream_end);
        ax_stream_header* header = (ax_stream_header*)stream;
        size_t body = size - sizeof *header - sizeof ax_stream_end;
        header->order %= 4;
        header->vertex_count = header->vertex_count % (body / 24 + 1);
        header->face_count = (body - 24 * header->vertex_count) / 12;
    }
    bytes rest = {stream, size};
    ax_mesh mesh;
    ax_vertex_order order;
    if (ax_stream_receive(take, &rest, &mesh, &order)) {
        ax_surface_make(&mesh, order, NULL, NULL);
        ax_mesh_free(&mesh);
    } else if (mesh.positions || mesh.faces) {
        abort();
    }
    free(stream);
    return 0;
}
