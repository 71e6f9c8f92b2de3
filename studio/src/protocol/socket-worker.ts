// Sockets apart from the page: a state comes in dozens of pieces, and each would wait until the page has drawn. Asked for by address,
// with a port: what comes in through it is sent, null closes; told through it are true for open, false for closed, and what came.
addEventListener("message", ({ data: address, ports: [port] }: MessageEvent<string>) => {
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => port.postMessage(true);
    socket.onclose = () => port.postMessage(false);
    socket.onmessage = ({ data }) => port.postMessage(data, typeof data === "string" ? [] : [data]);
    port.onmessage = ({ data }: MessageEvent<string | null>) => (data === null ? socket.close() : socket.send(data));
});
