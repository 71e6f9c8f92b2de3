// The socket, apart from the page: a state comes in dozens of pieces, and each would wait until the page has drawn. The first message
// is the address, the others are what is to be sent. Told to the page: true when it is open, false when it is closed, and what came.
let socket: WebSocket | null = null;

addEventListener("message", ({ data }: MessageEvent<string>) => {
    if (socket) {
        socket.send(data);
        return;
    }
    socket = new WebSocket(data);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => postMessage(true);
    socket.onclose = () => postMessage(false);
    socket.onmessage = ({ data: came }) => postMessage(came, { transfer: typeof came === "string" ? [] : [came] });
});
