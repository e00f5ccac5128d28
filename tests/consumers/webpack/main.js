import { job, show } from '../job.js';

show(job());
