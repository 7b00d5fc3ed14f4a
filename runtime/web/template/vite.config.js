import { streamkernel } from 'streamkernel/vite';

// skc is the one that the variable SKC names, or the one on PATH; or name it here: streamkernel({ skc: '/path/to/skc' })
export default { plugins: [streamkernel()] };
