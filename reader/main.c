// auxshell-read-mesh BYTES SECONDS UP FILE: parses a mesh file with assimp under limits on memory and processor time, and
// writes its triangles, turned so that z points up, to standard output as mesh/stream.h describes. UP is file, y or z. What is
// wrong with the file goes to standard error, as sentences.
#include "inspect.h"
#include "mesh/stream.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static _Noreturn void stop(int code, const char* format, ...) __attribute__((format(printf, 2, 3)));

static _Noreturn void stop(int code, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fflush(stderr);
    _exit(code);
}

static void limit(const char* bytes, const char* seconds)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL); // nobody is left to read
    struct rlimit none = {0}, time = {.rlim_cur = strtoull(seconds, NULL, 10), .rlim_max = RLIM_INFINITY};
    setrlimit(RLIMIT_CORE, &none);
    setrlimit(RLIMIT_CPU, &time);
#ifdef AX_SANITIZED
    (void)bytes; // the sanitizers' shadow needs terabytes of addresses
#else
    struct rlimit space = {.rlim_cur = strtoull(bytes, NULL, 10), .rlim_max = RLIM_INFINITY};
    setrlimit(RLIMIT_AS, &space);
#endif
}

static void inspect_file(const char* path)
{
    int file = open(path, O_RDONLY | O_CLOEXEC);
    struct stat info;
    if (file < 0 || fstat(file, &info) != 0)
        stop(ax_reader_bad_input, "The file cannot be opened: %s. Check the name and the rights.", strerror(errno));
    size_t size = (size_t)info.st_size;
    void* data = size ? mmap(NULL, size, PROT_READ, MAP_PRIVATE, file, 0) : "";
    if (data == MAP_FAILED)
        stop(ax_reader_bad_input, "The file cannot be read: %s.", strerror(errno));
    inspection found;
    if (!inspect(path, data, size, &found))
        stop(ax_reader_bad_input, "%s", found.message);
    if (size)
        munmap(data, size);
    close(file);
}

// Nothing that changes geometry: polygons are divided after their corners were checked. The importer turns Collada's own up axis to y
// if that counts.
static const struct aiScene* import(const char* path, bool turn)
{
    struct aiPropertyStore* properties = aiCreatePropertyStore();
    aiSetImportPropertyInteger(properties, AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, !turn);
    const struct aiScene* scene = aiImportFileExWithProperties(path, 0, NULL, properties);
    aiReleasePropertyStore(properties);
    if (scene)
        return scene;
    const char* reason = aiGetErrorString();
    if (!strncmp(reason, "No suitable reader", 18))
        stop(ax_reader_bad_input,
             "It is in no format that can be read. Export the mesh as OBJ, STL, PLY or OFF; the ending of "
             "the name tells which it is.");
    if (strstr(reason, "bad_alloc"))
        stop(ax_reader_failed, "No more memory.");
    stop(ax_reader_bad_input, "It cannot be read as a mesh (%.300s). Export it again, as OBJ, STL, PLY or OFF.",
         *reason ? reason : "the importer gives no reason");
}

// True if it has polygons that must be divided.
static bool check_mesh(const struct aiMesh* mesh)
{
    bool polygons = false;
    for (unsigned f = 0; f < mesh->mNumFaces; ++f)
        for (unsigned k = 0; k < mesh->mFaces[f].mNumIndices; ++k) {
            unsigned v = mesh->mFaces[f].mIndices[k];
            if (v >= mesh->mNumVertices)
                stop(ax_reader_bad_input,
                     "Face %u (counted from 0) refers to vertex %u, but there are %u. Export the mesh again.", f, v,
                     mesh->mNumVertices);
            const struct aiVector3D* x = &mesh->mVertices[v];
            if (!isfinite(x->x) || !isfinite(x->y) || !isfinite(x->z))
                stop(ax_reader_bad_input,
                     "Face %u (counted from 0) has a corner at no finite place, (%g, %g, %g). Delete the face or give "
                     "its "
                     "corners coordinates.",
                     f, (double)x->x, (double)x->y, (double)x->z);
            polygons = polygons || k > 2;
        }
    return polygons;
}

// How the vertices came about decides what messages may say of them.
static ax_vertex_order order_of(const struct aiScene* scene, const char* path)
{
    uint64_t corners = 0, vertices = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        vertices += scene->mMeshes[m]->mNumVertices;
        for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; ++f)
            corners += scene->mMeshes[m]->mFaces[f].mNumIndices;
    }
    if (corners != vertices)
        return scene->mNumMeshes == 1 ? AX_VERTICES_NUMBERED : AX_VERTICES_SPLIT;
    const char* ending = strrchr(path, '.');
    return ending && !strcasecmp(ending, ".stl") ? AX_VERTICES_REPEATED : AX_VERTICES_SPLIT;
}

static bool ends_in(const char* path, const char* ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length >= tail && !strcasecmp(path + length - tail, ending);
}

// As the format says, or the file itself.
static bool has_y_up(const struct aiScene* scene, const char* path)
{
    if (ends_in(path, ".gltf") || ends_in(path, ".glb") || ends_in(path, ".dae"))
        return true;
    for (unsigned k = 0; scene->mMetaData && k < scene->mMetaData->mNumProperties; ++k) {
        const struct aiMetadataEntry* entry = &scene->mMetaData->mValues[k];
        if (!strcmp(scene->mMetaData->mKeys[k].data, "UpAxis") && entry->mType == AI_INT32)
            return *(const int32_t*)entry->mData == 1; // FBX: x, y, z
    }
    return false;
}

// Where a mesh stands in the scene; a mesh may stand in several places.
typedef struct instance {
    const struct aiMesh* mesh;
    struct aiMatrix4x4 place;
    bool moved;
} instance;

typedef struct instances {
    size_t count, capacity;
    instance* items;
    uint64_t vertices, faces;
    bool y_up;
} instances;

static void collect(instances* all, const struct aiScene* scene, const struct aiNode* node, struct aiMatrix4x4 place)
{
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    aiMultiplyMatrix4(&place, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        if (all->count == all->capacity) {
            all->capacity = 2 * all->capacity + 16;
            all->items = realloc(all->items, all->capacity * sizeof *all->items);
            if (!all->items)
                abort();
        }
        const struct aiMesh* mesh = scene->mMeshes[node->mMeshes[i]];
        all->items[all->count++] = (instance){mesh, place, memcmp(&place, &identity, sizeof place) != 0};
        all->vertices += mesh->mNumVertices;
        for (unsigned f = 0; f < mesh->mNumFaces; ++f)
            all->faces += mesh->mFaces[f].mNumIndices == 3; // others are points and lines
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i)
        collect(all, scene, node->mChildren[i], place);
}

static void position(const instances* all, size_t i, unsigned vertex, double out[3])
{
    const instance* at = &all->items[i];
    struct aiVector3D x = at->mesh->mVertices[vertex];
    if (at->moved)
        aiTransformVecByMatrix4(&x, &at->place);
    out[0] = (double)x.x;
    out[1] = (double)(all->y_up ? -x.z : x.y);
    out[2] = (double)(all->y_up ? x.y : x.z);
}

// The importer keeps seven digits: far from the origin they do not describe the shape any more.
static void check_precision(const instances* all)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY}, reach = 0, square = 0;
    for (size_t i = 0; i < all->count; ++i)
        for (unsigned v = 0; v < all->items[i].mesh->mNumVertices; ++v) {
            double x[3];
            position(all, i, v, x);
            for (int d = 0; d < 3; ++d) {
                lo[d] = x[d] < lo[d] ? x[d] : lo[d];
                hi[d] = x[d] > hi[d] ? x[d] : hi[d];
            }
        }
    for (int d = 0; d < 3; ++d) {
        reach = fmax(reach, fmax(fabs(lo[d]), fabs(hi[d])));
        square += (hi[d] - lo[d]) * (hi[d] - lo[d]);
    }
    if (square > 0 && reach * 0x1p-23 > 1e-5 * sqrt(square))
        stop(ax_reader_bad_input,
             "The mesh is %.3g long but lies as far as %.3g from the origin, where coordinates are read to no better "
             "than %.1g. "
             "Move it to the origin and export it again.",
             sqrt(square), reach, reach * 0x1p-23);
}

// Standard output, in large pieces.
typedef struct sink {
    size_t used;
    char bytes[1 << 18];
} sink;

static void flush(sink* out)
{
    for (size_t done = 0; done < out->used;) {
        ssize_t written = write(STDOUT_FILENO, out->bytes + done, out->used - done);
        if (written < 0 && errno != EINTR)
            _exit(ax_reader_failed); // the receiver has gone
        done += written > 0 ? (size_t)written : 0;
    }
    out->used = 0;
}

static void put(sink* out, const void* data, size_t size)
{
    if (out->used + size > sizeof out->bytes)
        flush(out);
    memcpy(out->bytes + out->used, data, size);
    out->used += size;
}

static void send(const instances* all, ax_vertex_order order)
{
    static sink out;
    ax_stream_header header = {.order = order, .vertex_count = all->vertices, .face_count = all->faces};
    memcpy(header.magic, ax_stream_magic, sizeof header.magic);
    put(&out, &header, sizeof header);
    for (size_t i = 0; i < all->count; ++i)
        for (unsigned v = 0; v < all->items[i].mesh->mNumVertices; ++v) {
            double x[3];
            position(all, i, v, x);
            put(&out, x, sizeof x);
        }
    int32_t first = 0;
    for (size_t i = 0; i < all->count; ++i) {
        const struct aiMesh* mesh = all->items[i].mesh;
        for (unsigned f = 0; f < mesh->mNumFaces; ++f)
            if (mesh->mFaces[f].mNumIndices == 3) {
                int32_t face[3];
                for (int k = 0; k < 3; ++k)
                    face[k] = first + (int32_t)mesh->mFaces[f].mIndices[k];
                put(&out, face, sizeof face);
            }
        first += (int32_t)mesh->mNumVertices;
    }
    put(&out, ax_stream_end, sizeof ax_stream_end);
    flush(&out);
}

int main(int argc, char** argv)
{
    if (argc != 5)
        stop(ax_reader_failed, "usage: auxshell-read-mesh BYTES SECONDS UP FILE\n");
    limit(argv[1], argv[2]);
    const char *up = argv[3], *path = argv[4];
    inspect_file(path);
    const struct aiScene* scene = import(path, !strcmp(up, "file"));
    ax_vertex_order order = order_of(scene, path);
    bool polygons = false;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
        polygons = check_mesh(scene->mMeshes[m]) || polygons;
    if (polygons)
        scene = aiApplyPostProcessing(scene, aiProcess_Triangulate);

    instances all = {.y_up = !strcmp(up, "y")};
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    if (scene && scene->mRootNode)
        collect(&all, scene, scene->mRootNode, identity);
    if (scene && !strcmp(up, "file"))
        all.y_up = has_y_up(scene, path);
    if (!all.faces)
        stop(ax_reader_bad_input, "There are no faces in it. Export a surface of triangles or polygons.");
    if (all.faces > ax_stream_most_faces || all.vertices > ax_stream_most_vertices)
        stop(ax_reader_bad_input, "It has %llu triangles, and at most %d can be read. Reduce the mesh.",
             (unsigned long long)all.faces, ax_stream_most_faces);
    check_precision(&all);
    send(&all, order);
    _exit(ax_reader_done); // taking the scene apart again would take as long as writing it
}
