"""A studio as a process, and a client that speaks its protocol with nothing but sockets."""
import base64
import http.client
import json
import os
import re
import signal
import socket
import struct
import subprocess
import time

from support.command import AUXSHELL

SECTIONS = {1: "triangles", 2: "hole_start", 3: "hole_hinges", 4: "opening_start", 5: "opening_hinges", 6: "on_rim", 7: "panels",
            8: "names", 9: "sheet", 16: "flat", 17: "deployed", 18: "simulated", 20: "prescribed", 21: "realised", 22: "opening",
            23: "material", 24: "mouth", 25: "residual", 26: "curvature", 27: "edge_forces", 28: "supports", 29: "reactions",
            32: "vertices", 33: "faces", 34: "vertex_curvature", 35: "vertex_scale", 40: "place", 41: "share", 42: "times"}
SETTLED, EXACT, MOVING, PREVIEW = 1, 2, 4, 8


class Closed(Exception):
    """The server closed the connection; `code` is that of its close frame, None without one."""

    def __init__(self, code=None):
        super().__init__(f"closed with {code}")
        self.code = code


class Frame:
    """A binary frame, taken apart; its padding and size are checked."""

    def __init__(self, data):
        magic, self.kind, self.re, self.topology, self.revision, self.serial, self.flags, count = struct.unpack_from("<8I", data)
        assert magic == 0x31465841
        self.sections, at = {}, 32
        for _ in range(count):
            section, kind, numbers = struct.unpack_from("<3I", data, at)
            size = numbers * (1 if kind == 3 else 4)
            values = struct.unpack_from(f"<{numbers}{'_fiB'[kind]}", data, at + 12)
            self.sections[SECTIONS[section]] = tuple(None if value != value else value for value in values)  # NaN equals nothing
            at += 12 + (size + 3 & ~3)
        assert at == len(data)


class Socket:
    """A WebSocket client of RFC 6455, as plain as can be: what it sends may be wrong on purpose."""

    def __init__(self, port, path, host=None, origin=None, extra=""):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        origin = f"http://127.0.0.1:{port}" if origin is None else origin
        key = base64.b64encode(os.urandom(16)).decode()
        self.raw(f"GET {path} HTTP/1.1\r\nHost: {host or f'127.0.0.1:{port}'}\r\n"
                 + (f"Origin: {origin}\r\n" if origin else "")
                 + f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                   f"Sec-WebSocket-Version: 13\r\n{extra}\r\n")
        self.buffer = b""
        try:
            while b"\r\n\r\n" not in self.buffer:
                self.more()
            head, _, self.buffer = self.buffer.partition(b"\r\n\r\n")
            self.status = int(head.split()[1])
        except (Closed, ConnectionError):
            self.status = None  # hung up without a word

    def raw(self, data):
        self.socket.sendall(data.encode() if isinstance(data, str) else data)

    def more(self):
        data = self.socket.recv(1 << 20)
        if not data:
            raise Closed()
        self.buffer += data

    def take(self, count):
        while len(self.buffer) < count:
            self.more()
        data, self.buffer = self.buffer[:count], self.buffer[count:]
        return data

    def send(self, payload, opcode=1, final=True, masked=True):
        payload = payload if isinstance(payload, bytes) else payload.encode()
        size, bit = len(payload), 128 if masked else 0
        head = bytes([(128 if final else 0) | opcode])
        head += (bytes([bit | size]) if size < 126 else bytes([bit | 126]) + struct.pack(">H", size) if size < 65536
                 else bytes([bit | 127]) + struct.pack(">Q", size))
        if masked:
            mask = os.urandom(4)
            stream = (mask * (size // 4 + 1))[:size]
            payload = (int.from_bytes(payload, "big") ^ int.from_bytes(stream, "big")).to_bytes(size, "big")
            head += mask
        self.raw(head + payload)

    def receive(self):
        """The next message: a dict, or a Frame."""
        whole, kind = b"", None
        while True:
            first, second = self.take(2)
            size = second & 127
            size = struct.unpack(">H", self.take(2))[0] if size == 126 else struct.unpack(">Q", self.take(8))[0] if size == 127 else size
            payload, opcode = self.take(size), first & 15
            if opcode == 8:
                raise Closed(struct.unpack(">H", payload[:2])[0] if len(payload) >= 2 else None)
            if opcode == 9:
                self.send(payload, 10)
            if opcode > 8:
                continue
            kind = opcode or kind
            whole += payload
            if first & 128:
                return json.loads(whole) if kind == 1 else Frame(whole)

    def close(self):
        self.socket.close()


class Page(Socket):
    """A page: keeps what it was told last, as the real one does."""

    def __init__(self, studio, **options):
        super().__init__(studio.port, f"/ws?key={studio.secret}", **options)
        self.events, self.state, self.frames, self.problems, self.others, self.number = {}, {}, 0, [], [], 0
        if self.status == 101:
            self.hello = self.read()

    def read(self):
        message = self.receive()
        if isinstance(message, Frame):
            if message.kind == 1:
                self.frames += 1
                self.last = message
                self.state.update(message.sections)
            else:
                self.others.append(message)
        elif message.get("event") == "problem":
            self.problems.append(message)
        elif "event" in message:
            self.events[message["event"]] = message
        return message

    def tell(self, action, **parameters):
        self.send(json.dumps({"do": action, **parameters}))

    def ask(self, action, **parameters):
        """The answer; what comes before it is kept."""
        self.number += 1
        self.tell(action, id=self.number, **parameters)
        while True:
            message = self.read()
            if isinstance(message, dict) and message.get("re") == self.number and "ok" in message:
                return message

    def until(self, true, seconds=60):
        """Reads on until this holds."""
        end = time.monotonic() + seconds
        while not true():
            assert time.monotonic() < end, "it did not come"
            self.read()

    def rest(self, seconds=60):
        """Until the state is at rest and its report is in."""
        self.until(lambda: self.frames and not self.last.flags & MOVING and {"report", "document"} <= self.events.keys()
                   and self.last.revision >= self.events["report"]["revision"] and self.events.get("status", {}).get("solver") == "idle", seconds)


class Studio:
    def __init__(self, folder, *words, document=None, environment=None):
        command = [AUXSHELL, "studio", *([str(document)] if document else [str(folder)]), "--no-browser", *map(str, words)]
        state = folder / "state"
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder,
                                        env={**os.environ, "XDG_STATE_HOME": str(state), "TMPDIR": str(folder), **(environment or {})})
        line = self.process.stdout.readline()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/(\w+)/\n", line)
        if not found:
            raise AssertionError(f"no address: {line}{self.process.stderr.read()}")
        self.port, self.secret = int(found[1]), found[2]

    def request(self, method, path, body=None, headers=None):
        """Status, headers and body of the answer; `path` goes after the secret. (None, ...) where it hung up without one."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            connection.request(method, f"/{self.secret}{path}", body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        except (http.client.RemoteDisconnected, ConnectionError):
            return None, None, None
        finally:
            connection.close()

    def upload(self, name, data):
        status, _, body = self.request("POST", f"/upload?name={name}", data, {"Origin": f"http://127.0.0.1:{self.port}"})
        assert status == 200, (status, body)
        return json.loads(body)["upload"]

    def stop(self, how=signal.SIGINT):
        """Its exit code, and what it said on stderr."""
        self.process.send_signal(how)
        _, said = self.process.communicate(timeout=60)
        return self.process.returncode, said
